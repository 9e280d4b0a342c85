//! A profile without a contour is drawn by the search on the map, and the renderer adds a note.

use crate::common::prelude::*;
use revmap_searches::CONE;

#[test]
fn what_has_no_contour_is_drawn_from_the_map() {
    let mut scene = scene_of(shapes::crossing(), eye(20.0, 2.2));
    let mut ball = Object::new("ball", Arc::new(shapes::sphere()));
    ball.placement.position.x = -0.6;
    scene.objects.push(ball);
    for (stage, shadow) in [
        (DrawStage::Fragment, Shadow::Off),
        (DrawStage::Compute, Shadow::Off),
        (DrawStage::Fragment, Shadow::Hard),
    ] {
        scene.shadow = shadow;
        let settings = drawn_by((200, 150), stage, Solver::DEFAULT);
        let live = drawn_by((200, 150), stage, Solver::Live);
        let drawn = revmap_offscreen::draw(device(), &scene, &settings).unwrap();
        let [note] = drawn.notes.as_slice() else {
            unreachable!("{:?}", drawn.notes)
        };
        let told = note.contains("object.0 (test)") && note.contains("live");
        assert!(told, "{note}");
        let wanted = draw(&scene, &live);
        let hits = hits(&wanted);
        assert!(hits > 3000, "{hits}");
        // The picture is that of the map's own search up to rounding; the ball keeps its search.
        let far = |&i: &usize| {
            let (a, b) = (wanted.distance[i], drawn.frame.distance[i]);
            a.is_finite() != b.is_finite() || (a - b).abs() >= 1e-3
        };
        let far = (0..wanted.pixels()).filter(far).count();
        assert!(far <= 10, "{far} of {hits}");
    }
    // The note appears once, however often the scene is drawn.
    let settings = Settings::exact();
    let mut renderer = Offscreen::new(device(), &scene, &settings).unwrap();
    scene.camera.eye.x += 0.1;
    renderer.update(&scene).unwrap();
    renderer.draw().unwrap();
    assert_eq!(renderer.renderer().notes().len(), 1);
    // The contour is not tried again. No surface is made, because shadows draw both by the map.
    assert_eq!(renderer.renderer().rebuild_count(), 1);
    // Objects with a contour add no note.
    scene.objects.remove(0);
    let drawn = revmap_offscreen::draw(device(), &scene, &settings).unwrap();
    assert!(drawn.notes.is_empty());
    device().check().unwrap();
}

/// A line on the axis has no surface to follow and encloses nothing. Searches on the map draw
/// nothing; other searches report that they cannot draw it.
#[test]
fn what_has_no_surface_is_drawn_from_the_map() {
    let line = [0.1, 0.5, 0.9].map(|z| DVec2::new(0.0, z)).to_vec();
    let line = Profile::new(Outline { loops: vec![line] }, 0.5);
    let mut scene = scene_of(shapes::sphere(), eye(20.0, 2.2));
    let mut alone = Object::new("line", Arc::new(line));
    alone.placement.position.x = 0.3;
    for stage in STAGES {
        let settings = Settings {
            proxy_min_pixels: 0,
            ..drawn_by((200, 150), stage, Solver::DEFAULT)
        };
        scene.objects.truncate(1);
        let wanted = draw(&scene, &settings);
        scene.objects.push(alone.clone());
        for solver in [Solver::Quadric, Solver::Exact] {
            let settings = Settings { solver, ..settings };
            let drawn = revmap_offscreen::draw(device(), &scene, &settings).unwrap();
            let [note] = drawn.notes.as_slice() else {
                unreachable!("{:?}", drawn.notes)
            };
            assert!(note.contains("object.1 (line)") && note.contains("no surface"));
            let same = |&i: &usize| {
                let (a, b) = (wanted.distance[i], drawn.frame.distance[i]);
                wanted.hits(i) == drawn.frame.hits(i) && (a == b || (a - b).abs() < 1e-3)
            };
            let same = (0..wanted.pixels()).filter(same).count();
            // The sphere's search with `quadric` differs from the default.
            assert!(same + 3 >= wanted.pixels(), "{same} of {}", wanted.pixels());
        }
        let cone = settings.with(|s| s.solver = CONE);
        let error = Offscreen::new(device(), &scene, &cone).err().unwrap();
        assert_eq!(error.key.as_deref(), Some("object.1.profile"), "{error}");
        assert!(error.message.contains("no surface"), "{error}");
    }
    device().check().unwrap();
}

/// Under shadows the map's search replaces that of all objects. It is planned as if the others had
/// never had a surface: their surfaces bound other solids than the map's.
#[test]
fn surfaces_of_another_search_are_not_planned() {
    let mut scene = scene_of(shapes::vase(), eye(20.0, 2.2));
    scene.shadow = Shadow::Hard;
    for stage in STAGES {
        let settings = drawn_by((200, 150), stage, Solver::DEFAULT);
        let mut scene = scene.clone();
        let mut renderer = Offscreen::new(device(), &scene, &settings).unwrap();
        renderer.draw().unwrap();
        assert!(renderer.renderer().object_costs()[0].table_bytes > 0);
        let mut other = Object::new("crossing", Arc::new(shapes::crossing()));
        other.placement.position.x = -1.0;
        scene.objects.push(other);
        renderer.update(&scene).unwrap();
        renderer.draw().unwrap();
        let costs = renderer.renderer().object_costs();
        let cost = (costs[0].table_bytes, costs[0].patches);
        assert_eq!(cost, (0, 0), "{costs:?}");
        // Once it is removed, the others are drawn as if it had never been there.
        scene.objects.pop();
        let found = updated(&mut renderer, &scene);
        assert_eq!(found.first_difference(&draw(&scene, &settings)), None);
    }
    device().check().unwrap();
}
