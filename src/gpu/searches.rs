//! Which search draws each object of a frame, and by which tables.

use super::contours::{Contours, named};
use super::cuts::{Cut, Cuts};
use crate::error::Result;
use crate::scene::{Scene, Shadow};
use crate::settings::{Settings, Solver};
use std::sync::Arc;

/// The search of what has no contour: it reads the map alone.
const FALLBACK: Solver = Solver::Live;

/// What a frame's objects are searched by.
pub(crate) struct Searches {
    /// The tables of each object; none where its contour does not close, or where no tables are searched.
    cuts: Vec<Option<Arc<Cut>>>,
    asked: Solver,
    notes: Vec<String>,
}

impl Searches {
    /// Cuts what was not cut in the frame before.
    ///
    /// # Errors
    /// Where the search asked for cannot draw an object, and another must be asked for.
    pub fn new(
        kept: &mut Cuts,
        contours: &Contours,
        scene: &Scene,
        settings: &Settings,
    ) -> Result<Self> {
        let mut searches = Self {
            cuts: Vec::new(),
            asked: settings.solver,
            notes: Vec::new(),
        };
        if settings.solver.reads_map() || settings.solver.is_mesh() {
            return Ok(searches);
        }
        searches.cut(kept, contours, scene, settings)?;
        // A shadow's ray meets every solid by one search.
        if scene.shadow != Shadow::Off && searches.cuts.iter().any(Option::is_none) {
            searches.cuts.clear();
        }
        Ok(searches)
    }

    fn cut(
        &mut self,
        kept: &mut Cuts,
        contours: &Contours,
        scene: &Scene,
        settings: &Settings,
    ) -> Result<()> {
        for (number, object) in scene.objects.iter().enumerate() {
            let contour = contours.get(object)?;
            if self.asked.is_of_cones() {
                let rows = settings.map_rows.unwrap_or(object.map_rows);
                let relaxed = self.asked == Solver::Relaxed;
                let cones = kept.cones(contour, &object.offset, rows, relaxed);
                self.cuts
                    .push(Some(cones.map_err(|e| named(e, number, object))?));
                continue;
            }
            let found = kept.pieces(contour, &object.offset);
            if let Err(error) = &found {
                self.notes.push(format!(
                    "object.{number} ({}) is drawn by the search {} in place of {}: {}",
                    object.name,
                    FALLBACK.name(),
                    self.asked.name(),
                    error.message
                ));
            }
            self.cuts.push(found.ok());
        }
        Ok(())
    }

    /// What is done in another way than asked for.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The search of object `number`.
    pub fn solver(&self, number: usize) -> Solver {
        match self.asked {
            Solver::Quadric | Solver::Hull if self.tables(number).is_none() => FALLBACK,
            asked => asked,
        }
    }

    /// Its tables, where it has any.
    pub fn tables(&self, number: usize) -> Option<&Arc<Cut>> {
        self.cuts.get(number)?.as_ref()
    }
}
