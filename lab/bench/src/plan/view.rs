//! A scene and its name, seen from one place.

use glam::DVec3;
use revmap::scene::{Offset, Scene};
use revmap::settings::name_of;
use revmap_figures::groups::one;
use std::sync::Arc;

/// A scene to be measured.
#[derive(Clone, Debug)]
pub struct View {
    /// Its name in results.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// How much of the picture its solids take.
    pub framing: Framing,
    /// The name of the plan's entry that it comes from.
    pub group: String,
    /// The parameter of its form, in plans that vary one.
    pub value: Option<f64>,
    /// The scene file, with what the command line changes in it.
    pub file: Option<Arc<toml::Table>>,
    /// True if the offset is another one in each frame that is timed.
    pub offset_moves: bool,
}

/// How much of the picture is solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Framing {
    /// The scene's own camera: the program's solids fill nine tenths of the height or width.
    Whole,
    /// The field of view narrowed until the boxes are larger than a picture of 4:3 by the factor
    /// `OVERFILL` in `framing.rs`; a wider one may show their sides.
    Close,
}

impl Framing {
    /// The names in options and results.
    pub const NAMES: [(&'static str, Self); 2] = [("whole", Self::Whole), ("close", Self::Close)];

    /// Its name.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, &self)
    }
}

/// The form of an offset (articles of 2022 and 2025): `w = 0`, `e`, `e + b u`, `e + b min(u, c)`.
fn technique(offset: &Offset) -> &'static str {
    let beveled = offset.bevel != 0.0 && offset.chamfer > 0.0;
    match (offset.extend != 0.0, beveled) {
        (false, false) => "revolution",
        (true, false) => "extended",
        (_, true) if offset.chamfer < 1.0 => "chamfered",
        (_, true) => "beveled",
    }
}

impl View {
    /// A scene under a name.
    pub fn new(name: impl Into<String>, scene: Scene) -> Self {
        Self {
            name: name.into(),
            scene,
            framing: Framing::Whole,
            group: String::new(),
            value: None,
            file: None,
            offset_moves: false,
        }
    }

    /// Applies the offset of a frame of a view whose offset moves: each object grows by up to a
    /// fiftieth of its height, never twice by the same.
    pub(crate) fn move_offset(&self, scene: &mut Scene, frame: u32) {
        for (object, still) in scene.objects.iter_mut().zip(&self.scene.objects) {
            let growth = 0.01 * (1.0 + (0.37 * f64::from(frame)).sin());
            object.offset.extend = still.offset.extend + growth;
        }
    }

    /// The same view, of a scene file with this text.
    pub fn of_file(mut self, text: &str) -> Self {
        self.file = text.parse().ok().map(Arc::new);
        self
    }

    /// The form of its objects' offsets, as results name it.
    pub fn technique(&self) -> &'static str {
        let forms = self.scene.objects.iter().map(|o| technique(&o.offset));
        match self.scene.objects.is_empty() {
            true => "revolution",
            false => one(forms).unwrap_or("mixed"),
        }
    }

    /// The offset, where all objects have the same.
    pub fn offset(&self) -> Option<Offset> {
        one(self.scene.objects.iter().map(|o| o.offset))
    }

    /// Solids to be seen, copies counted.
    pub fn solids(&self) -> usize {
        let copies = self.scene.objects.iter().map(|o| o.placements().len());
        copies.sum()
    }

    /// World length of a texel of a 512-row map under the smallest factor of scale: the unit of
    /// depth errors, whatever rows the drawn map has.
    pub fn texel(&self) -> f64 {
        let placements = self.scene.objects.iter().flat_map(|o| o.placements());
        let least = placements.fold(f64::INFINITY, |s, p| s.min(p.scale.min_element()));
        let known = least.is_finite() && least > 0.0;
        if known { least / 512.0 } else { 1.0 / 512.0 }
    }

    /// The same scene seen from `degrees` above the horizon: the eye moves on a circle about its
    /// target, towards or away from the zenith. The name gets `@degrees`.
    pub fn at_elevation(mut self, degrees: f64) -> Self {
        let camera = &mut self.scene.camera;
        let back = camera.eye - camera.target;
        let mut level = DVec3::new(back.x, back.y, 0.0);
        let steep = level.length() <= 1e-9 * back.length();
        level = if steep { DVec3::X } else { level.normalize() };
        let (sin, cos) = degrees.to_radians().sin_cos();
        camera.eye = camera.target + back.length() * (level * cos + DVec3::Z * sin);
        // Straight from above there is no up but sideways.
        camera.up = if cos.abs() < 1e-6 { -level } else { DVec3::Z };
        self.name = format!(
            "{}@{}",
            self.name,
            revmap_figures::names::number(degrees, 4)
        );
        self
    }
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use revmap::profile::Profile;
    use revmap::scene::{Camera, Object, Placement};

    /// A double cone.
    pub(crate) fn spindle() -> View {
        let profile = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5).unwrap();
        let (eye, target) = (DVec3::new(2.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 0.5));
        let mut scene = Scene::new(Camera::new(eye, target));
        scene.objects = vec![Object::new("spindle", Arc::new(profile))];
        View::new("spindle", scene)
    }

    #[test]
    fn techniques_are_told_from_offsets() {
        for (extend, bevel, chamfer, wanted) in [
            (0.0, 0.0, 1.0, "revolution"),
            (0.1, 0.0, 0.5, "extended"),
            (0.1, 0.2, 1.0, "beveled"),
            (0.0, 0.2, 0.5, "chamfered"),
            (0.0, 0.2, 0.0, "revolution"),
        ] {
            let offset = Offset {
                extend,
                bevel,
                chamfer,
            };
            assert_eq!(technique(&offset), wanted);
        }
        let mut two = spindle();
        two.scene.objects.push(two.scene.objects[0].clone());
        assert_eq!(two.technique(), "revolution");
        two.scene.objects[1].offset.extend = 0.1;
        assert_eq!((two.technique(), two.offset()), ("mixed", None));
    }

    #[test]
    fn elevation_turns_the_eye_about_its_target() {
        for degrees in [0.0, 25.0, 60.0, 90.0, -30.0] {
            let camera = spindle().at_elevation(degrees).scene.camera;
            let back = camera.eye - camera.target;
            assert!((back.length() - 2.0).abs() < 1e-12);
            assert!((back.z / 2.0 - degrees.to_radians().sin()).abs() < 1e-12);
            let across = back.normalize().cross(camera.up);
            assert!(across.length() > 0.1, "{degrees}");
        }
        assert_eq!(spindle().at_elevation(25.0).name, "spindle@25");
    }

    #[test]
    fn the_texel_follows_the_smallest_scale() {
        let mut view = spindle();
        assert_eq!(view.texel(), 1.0 / 512.0);
        view.scene.objects[0].instances = vec![
            Placement {
                scale: DVec3::new(2.0, 0.5, 1.0),
                ..Placement::default()
            },
            Placement::default(),
        ]
        .into();
        assert_eq!((view.texel(), view.solids()), (0.5 / 512.0, 2));
    }
}
