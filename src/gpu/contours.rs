//! What the searches that read no map are made from: the contour of each profile, as far as no offset changes it.

use crate::error::{Error, Result, Stage};
use crate::pieces::{Contour, ContourSource, CutOptions};
use crate::profile::Profile;
use crate::scene::{Object, Offset, Scene};
use crate::settings::Settings;
use std::sync::Arc;

/// Those of a scene, each profile's once.
#[derive(Default)]
pub(crate) struct Contours {
    all: Vec<ProfileContour>,
}

/// What does not depend on the offset, of one profile.
pub(crate) struct ProfileContour {
    profile: Arc<Profile>,
    /// Or why there is none.
    source: Result<ContourSource>,
    pub options: CutOptions,
}

impl Contours {
    /// Of every profile of a scene; none where the search reads maps alone.
    ///
    /// # Errors
    /// Of a profile that has no contour, where nothing else than tables or a mesh will do.
    pub fn of(scene: &Scene, settings: &Settings) -> Result<Self> {
        let mut contours = Self::default();
        if settings.solver.reads_map() {
            return Ok(contours);
        }
        for (number, object) in scene.objects.iter().enumerate() {
            if contours.get(object).is_err() {
                let new = ProfileContour::new(object);
                if let Err(error) = &new.source
                    && (settings.solver.is_of_cones() || settings.solver.is_mesh())
                {
                    return Err(named(error.clone(), number, object));
                }
                contours.all.push(new);
            }
        }
        Ok(contours)
    }

    /// That of an object's profile.
    ///
    /// # Errors
    /// Where it is none of those that these were made from.
    pub fn get(&self, object: &Object) -> Result<&ProfileContour> {
        self.all
            .iter()
            .find(|c| Arc::ptr_eq(&c.profile, &object.profile))
            .ok_or_else(|| {
                Error::new(
                    Stage::Draw,
                    format!(
                        "{} is not what the renderer was made with; make a new one",
                        object.name
                    ),
                )
            })
    }
}

impl ProfileContour {
    fn new(object: &Object) -> Self {
        let profile = object.profile.clone();
        Self {
            source: ContourSource::new(&profile.outline),
            options: CutOptions::default(),
            profile,
        }
    }

    /// Equal for objects of one profile, and for no others while this lives.
    pub fn key(&self) -> usize {
        Arc::as_ptr(&self.profile) as usize
    }

    /// The contour under `offset`.
    ///
    /// # Errors
    /// Where the profile has none, or that of an odd one cannot be closed.
    pub fn contour(&self, offset: &Offset) -> Result<Contour> {
        match &self.source {
            Ok(source) => source.contour(offset),
            Err(error) => Err(error.clone()),
        }
    }
}

/// Adds whose contour it was that failed.
pub(crate) fn named(error: Error, number: usize, object: &Object) -> Error {
    let error = error.at_key(format!("object.{number}.profile"));
    match &object.file {
        Some(file) => error.in_file(file),
        None => error,
    }
}
