//! Objects with many copies that rays from the eye find by walking a hierarchy of boxes. Nothing here
//! depends on the view.

use super::casters::{Hierarchy, Leaf, middle_of};
use super::path::Path;
use super::{Call, Conditions, FramePlan, PlanObject, Step, View, projector};
use crate::shader::generated::{GROUP_PIXELS, MOST_GROUPS};
use crate::shader::{Drawn, Kind, Pushed, Variant};
use crate::solid::offset_surface::Part;
use rayon::prelude::*;
use std::collections::HashMap;

/// Objects that share a pipeline, a set of textures and a hierarchy of their copies.
#[derive(Clone, Debug, PartialEq)]
struct Layer {
    /// Indices of the objects.
    objects: Vec<u32>,
    /// Index of the root in [`Walks::hierarchy`].
    root: u32,
}

/// The hierarchies of all objects whose path is [`Path::Walk`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Walks {
    pub hierarchy: Hierarchy,
    layers: Vec<Layer>,
}

impl Walks {
    /// The hierarchies of the objects that rays from the eye walk.
    pub fn new(objects: &[PlanObject], with: &Conditions) -> Self {
        let mut layers: Vec<(Layer, Vec<Leaf>)> = Vec::new();
        let mut numbers = HashMap::new();
        for (n, of) in (0..).zip(objects).filter(|(_, of)| with.walks_to(of)) {
            let next = layers.len();
            let layer = *numbers.entry((of.technique, of.textures)).or_insert(next);
            if layer == next {
                let objects = Vec::new();
                layers.push((Layer { objects, root: 0 }, Vec::new()));
            }
            let (layer, leaves) = &mut layers[layer];
            layer.objects.push(n);
            let copies = of.object.placements().par_iter().enumerate();
            leaves.par_extend(copies.map(|(copy, placement)| {
                let instance = of.first_instance + copy as u32;
                Leaf::new(instance, 0, placement, &of.shape)
            }));
        }
        let first = layers.first().map_or(&[][..], |(_, leaves)| leaves);
        let mut hierarchy = Hierarchy::at(middle_of(first));
        let built = layers.into_iter().map(|(mut layer, mut leaves)| {
            layer.root = hierarchy.add(&mut leaves);
            layer
        });
        let layers = built.collect();
        Self { hierarchy, layers }
    }
}

impl FramePlan {
    /// The walks, after all else. `first`: index of the first node of their hierarchies.
    pub(super) fn add_walks(
        &mut self,
        view: &View,
        (objects, paths): (&[PlanObject], &[Path]),
        variants: &[Variant],
        (walks, first): (&Walks, u32),
        with: &Conditions,
    ) {
        let kind = if with.compute { Kind::WalkTiles } else { Kind::Walk };
        let last = self.steps.iter().map(|step| step.phase).max();
        let mut phase = last.unwrap_or(1).max(1);
        let projector = projector(view, objects, with);
        let [across, down] = projector.tiles();
        let tiles = projector.picture()[1] / GROUP_PIXELS * across..down * across;
        for layer in &walks.layers {
            let object = layer.objects[0];
            debug_assert!(layer.objects.iter().all(|&n| paths[n as usize] == Path::Walk));
            for &n in &layer.objects {
                self.parts[n as usize][Part::Tables as usize] = true;
            }
            let mut variant = variants[object as usize].seen_from_outside(false);
            if layer.objects.len() > 1 {
                variant.speciality.drawn = Drawn::Objects;
            }
            let root = first + layer.root;
            // Each layer compares its depths with those of the layers before it.
            phase += u32::from(with.compute);
            let step = |call| Step {
                phase: if with.compute { phase } else { 0 },
                variant: variant.of_kind(kind),
                kind,
                object,
                call,
            };
            if !with.compute {
                self.steps.push(step(Call::Tiles(root..root + 1)));
                continue;
            }
            for begin in tiles.clone().step_by(MOST_GROUPS as usize) {
                let pushed = Pushed {
                    first: begin,
                    tiles: across,
                    root,
                    object: objects[object as usize].number,
                    ..Pushed::default()
                };
                let groups = MOST_GROUPS.min(tiles.end - begin);
                self.steps.push(step(Call::Groups(groups, pushed)));
            }
        }
    }
}
