//! The hierarchy of all copies that may cast shadows, kept from view to view.

use super::Content;
use super::view_plan::ViewPlan;
use crate::plan::casters::{Hierarchy, Leaf};
use rayon::prelude::*;
use std::sync::Arc;

/// Copies, and the values that their boxes depend on: version of the content, mask of the view,
/// level of all surfaces.
pub(in crate::gpu) type Casters = ((u64, u32, u8), Arc<Hierarchy>);

impl Content {
    /// The hierarchy over the copies of a plan's objects. Builds it if they have changed.
    pub fn hierarchy(&mut self, plan: &ViewPlan) -> Arc<Hierarchy> {
        // With shadows, all surfaces have one level.
        let level = plan.objects.iter().map(|object| object.level).min();
        let key = (plan.version, plan.view.mask, level.unwrap_or(0));
        if let Some((known, hierarchy)) = &self.hierarchy
            && *known == key
        {
            return hierarchy.clone();
        }
        let mut leaves = Vec::new();
        for planned in &plan.objects {
            let Some(entry) = self.objects.at(planned.number) else {
                continue;
            };
            let Some(object) = entry.plan_object(planned, &self.settings) else {
                continue;
            };
            let map = entry
                .derived
                .as_ref()
                .map_or(0, |derived| derived.shadow_map);
            let copies = object.object.placements().par_iter().enumerate();
            leaves.par_extend(copies.map(|(copy, placement)| {
                let instance = object.first_instance + copy as u32;
                Leaf::new(instance, map, placement, &object.shape)
            }));
        }
        let made = Arc::new(Hierarchy::new(&mut leaves));
        self.hierarchy = Some((key, made.clone()));
        made
    }
}
