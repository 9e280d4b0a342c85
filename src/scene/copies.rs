//! The placements of an object's copies, and data derived from them once for all views.

use super::Placement;
use super::clusters::Clusters;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

/// Placements of copies; they are read and changed like a [`Vec`]. Clones share the placements
/// until one of them is changed, so that scenes of many copies are cheap to clone and to compare.
/// After the first drawing a second list keeps them in the order of their neighbourhood: 84 bytes a
/// copy.
///
/// ```
/// use revmap::scene::{Copies, Placement};
///
/// let mut copies: Copies = vec![Placement::default(); 3].into();
/// let before = copies.clone();
/// copies[1].position.x = 2.0;
/// copies.push(Placement::default());
/// assert!(copies.len() == 4 && before.len() == 3 && copies != before);
/// ```
#[derive(Clone, Default)]
pub struct Copies(Arc<Known>);

#[derive(Default)]
struct Known {
    placements: Vec<Placement>,
    /// Set once all were checked and found valid.
    checked: OnceLock<()>,
    clusters: OnceLock<Clusters>,
}

impl Copies {
    /// The clusters of the copies, made on the first call after a change.
    pub(crate) fn clusters(&self) -> &Clusters {
        let known = &self.0.clusters;
        if known.get().is_none() {
            // The clusters are made outside `get_or_init`: a rayon thread that waits there may run
            // a task that makes the same call.
            let _ = known.set(Clusters::new(self));
        }
        known.get_or_init(|| Clusters::new(self))
    }

    /// Calls `all` with all placements, unless an earlier call found them valid.
    pub(crate) fn unless_checked<E>(
        &self,
        all: impl FnOnce(&[Placement]) -> Result<(), E>,
    ) -> Result<(), E> {
        if self.0.checked.get().is_none() {
            all(self)?;
            self.0.checked.get_or_init(|| ());
        }
        Ok(())
    }
}

impl Clone for Known {
    /// Copies the placements only: the clone is about to change.
    fn clone(&self) -> Self {
        self.placements.clone().into()
    }
}

impl From<Vec<Placement>> for Known {
    fn from(placements: Vec<Placement>) -> Self {
        Self {
            placements,
            ..Self::default()
        }
    }
}

impl From<Vec<Placement>> for Copies {
    fn from(placements: Vec<Placement>) -> Self {
        Self(Arc::new(placements.into()))
    }
}

impl FromIterator<Placement> for Copies {
    fn from_iter<I: IntoIterator<Item = Placement>>(all: I) -> Self {
        Vec::from_iter(all).into()
    }
}

impl<'a> IntoIterator for &'a Copies {
    type Item = &'a Placement;
    type IntoIter = std::slice::Iter<'a, Placement>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Deref for Copies {
    type Target = Vec<Placement>;

    fn deref(&self) -> &Self::Target {
        &self.0.placements
    }
}

impl DerefMut for Copies {
    fn deref_mut(&mut self) -> &mut Self::Target {
        let known = Arc::make_mut(&mut self.0);
        (known.checked, known.clusters) = Default::default();
        &mut known.placements
    }
}

impl PartialEq for Copies {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || **self == **other
    }
}

impl fmt::Debug for Copies {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_list().entries(self).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Data derived from other placements is dropped, and clones are unchanged.
    #[test]
    fn a_change_is_seen_by_all_that_follows_from_it() {
        let mut copies: Copies = vec![Placement::default(); 100].into();
        let before = copies.clone();
        assert_eq!(copies.unless_checked(|_| Err("bad")), Err("bad"));
        assert_eq!(copies.unless_checked(|_| Ok::<_, &str>(())), Ok(()));
        assert_eq!(before.unless_checked(|_| Err("looked at twice")), Ok(()));
        assert_eq!(copies.clusters().all()[0].high.x, 0.0);
        copies.iter_mut().for_each(|copy| copy.position.x = 3.0);
        assert_eq!(copies.unless_checked(|_| Err("bad")), Err("bad"));
        assert_eq!(copies.clusters().all()[0].high.x, 3.0);
        assert_eq!(before.clusters().all()[0].high.x, 0.0);
        assert_ne!(copies, before);
        copies.iter_mut().for_each(|copy| copy.position.x = 0.0);
        assert_eq!(copies, before);
    }
}
