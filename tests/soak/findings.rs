//! Faults that random hosts found, each as a fixed sequence of calls.

use crate::common::host::{self, Attachments, Options, color_pass, opened, view_of};
use crate::common::shapes;
use ash::vk;
use glam::DVec3;
use revmap::gpu::{Device, Output, Renderer, View};
use revmap::scene::{Camera, Object, Scene, Shadow};
use revmap::settings::SearchSettings;
use std::sync::Arc;

const OPTIONS: Options = Options {
    width: 120,
    height: 90,
    dynamic: true,
    samples: 1,
    reversed: false,
};

fn new(device: &Device) -> Renderer {
    let exact = SearchSettings::exact();
    Renderer::new(device, Output::Pass(color_pass()), &exact, 1).unwrap()
}

fn picture(host: &host::Host, renderer: &mut Renderer, view: &View) -> Vec<u8> {
    let into = Attachments::new(host, OPTIONS, &[(host::COLOR, 4)]).unwrap();
    let black = [vk::ClearColorValue::default()];
    host::draw_into(host, &into, &black, renderer, view, None);
    into.color(0)
}

/// A solid without a contour makes the map's search draw all solids under shadows. Once it is
/// removed, the others are drawn as if it had never been there.
#[test]
fn a_removed_solid_leaves_no_search_behind() {
    let (host, device) = opened();
    let mut scene = Scene::new(Camera::new(DVec3::new(2.0, 0.8, 1.2), DVec3::Z * 0.5));
    scene.shadow = Shadow::Hard;
    let vase = Object::new("vase", Arc::new(shapes::vase()));
    scene.objects.push(vase.clone());
    let view = view_of(&scene, &OPTIONS);
    let mut kept = new(&device);
    host::add(&mut kept, &scene);
    let mut other = Object::new("crossing", Arc::new(shapes::crossing()));
    other.placement.position.x = -1.0;
    let other = kept.add(other).unwrap();
    let with = picture(&host, &mut kept, &view);
    kept.remove(other).unwrap();
    let found = picture(&host, &mut kept, &view);
    let mut fresh = new(&device);
    host::add(&mut fresh, &scene);
    let wanted = picture(&host, &mut fresh, &view);
    let differ = |a: &[u8]| a.iter().zip(&wanted).filter(|(a, b)| a != b).count();
    println!("{} bytes differ before the removal", differ(&with));
    assert_eq!(differ(&found), 0, "bytes differ after the removal");
}
