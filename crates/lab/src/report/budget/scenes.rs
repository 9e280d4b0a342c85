//! The ten scenes: six solids seen whole, one close, and solids of many sizes.

use crate::report::scaling::field;
use crate::report::suite::{self, Extent};
use crate::report::view::{Framing, View};
use glam::DVec3;
use revmap::error::Result;
use revmap::scene::{Camera, Placement};

/// Names of the solids that are seen whole.
const WHOLE: [&str; 6] = ["vase", "pawn", "bottle", "goblet", "rook", "king"];
/// Copies on the field: some 25 pixels each at 800x600.
const FIELD: u32 = 400;
/// Copies of each of three solids in the distant scene.
const DISTANT: u32 = 200;

/// The scenes.
///
/// # Errors
/// Of the solids that the program carries.
pub(super) fn scenes() -> Result<Vec<View>> {
    let all = suite::views(Extent::All, &[25.0])?;
    let named = |name: &str| all.iter().find(|v| v.name == name).cloned();
    let mut views: Vec<View> = WHOLE.into_iter().filter_map(named).collect();
    if let Some(vase) = named("vase") {
        views.push(vase.clone().in_framing(Framing::Close));
        views.push(field(&vase, FIELD));
    }
    if let Some(rook) = named("rook") {
        views.push(avenue(&rook));
    }
    if let (Some(mut pawn), Some(rook), Some(king)) = (named("pawn"), named("rook"), named("king"))
    {
        pawn.scene.objects.extend(rook.scene.objects);
        pawn.scene.objects.extend(king.scene.objects);
        views.push(distant(&pawn));
    }
    Ok(views)
}

/// Two lines of twelve objects that go into the distance: 300 pixels high to 10 at 800x600.
fn avenue(one: &View) -> View {
    let mut view = one.clone();
    view.name = format!("{}-avenue", one.name);
    let solid = view.scene.objects[0].clone();
    view.scene.objects = (0..24)
        .map(|k| {
            let mut object = solid.clone();
            let away = 2.75 * 1.36f64.powi(k / 2);
            let side = if k % 2 == 0 { -1.0 } else { 1.0 };
            object.placement.position = DVec3::new(-away, side * 0.32 * away.sqrt(), 0.0);
            object
        })
        .collect();
    view.scene.camera = Camera::new(DVec3::new(0.0, 0.0, 1.3), DVec3::new(-8.0, 0.0, 0.4));
    view
}

/// Copies of every object between 41 and 412 units away: 20 to 2 pixels high at 800x600.
fn distant(several: &View) -> View {
    let mut view = several.clone();
    view.name = "distant".into();
    let kinds = view.scene.objects.len() as u32;
    for (kind, object) in (0u32..).zip(&mut view.scene.objects) {
        object.instances = (0..DISTANT)
            .map(|k| {
                // Evenly over the depths, and to either side by the golden ratio.
                let n = f64::from(k * kinds + kind);
                let away = 41.0 * 10f64.powf(n / f64::from(kinds * DISTANT));
                let side = 0.9 * ((n * 0.618_033_988_749_895).fract() - 0.5);
                Placement {
                    position: DVec3::new(-away, side * away, 0.0),
                    ..Placement::default()
                }
            })
            .collect();
    }
    view.scene.camera = Camera::new(DVec3::new(0.0, 0.0, 14.0), DVec3::new(-70.0, 0.0, 0.0));
    view
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn ten_scenes_are_sound_and_named_once() {
        let all = scenes().unwrap();
        assert_eq!(all.len(), 10);
        for (i, view) in all.iter().enumerate() {
            view.scene.check().unwrap();
            assert!(view.scene.warnings(800, 600).is_empty(), "{}", view.name);
            assert!(all[..i].iter().all(|v| v.name != view.name));
        }
    }
}
