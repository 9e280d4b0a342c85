//! Where the copies of an object stand, and what is found out about them once for all views.

use super::Placement;
use super::clusters::Clusters;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

/// Placements of copies: a [`Vec`] to whoever reads or changes it. Clones share the placements
/// until one of them is changed, so that scenes of many copies are cheap to clone and to compare.
/// Once drawn they are kept a second time in the order of their neighbourhood: 84 bytes a copy.
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

/// Placements and what follows from them.
#[derive(Default)]
struct Known {
    placements: Vec<Placement>,
    /// Set once all were looked at and found right.
    checked: OnceLock<()>,
    clusters: OnceLock<Clusters>,
}

impl Copies {
    /// Their clusters, made when they are first asked for after a change.
    pub(crate) fn clusters(&self) -> &Clusters {
        let known = &self.0.clusters;
        if known.get().is_none() {
            // Not while others wait: a thread of rayon that waits may take up what asks again.
            let _ = known.set(Clusters::new(self));
        }
        known.get_or_init(|| Clusters::new(self))
    }

    /// Looks at all placements, unless they were found right before.
    pub(crate) fn check<E>(
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
    /// For whoever is about to change it.
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

    /// Nothing that was found out of other placements is kept, and clones stay as they were.
    #[test]
    fn a_change_is_seen_by_all_that_follows_from_it() {
        let mut copies: Copies = vec![Placement::default(); 100].into();
        let before = copies.clone();
        assert_eq!(copies.check(|_| Err("bad")), Err("bad"));
        assert_eq!(copies.check(|_| Ok::<_, &str>(())), Ok(()));
        assert_eq!(before.check(|_| Err("looked at twice")), Ok(()));
        assert_eq!(copies.clusters().all()[0].high.x, 0.0);
        copies.iter_mut().for_each(|copy| copy.position.x = 3.0);
        assert_eq!(copies.check(|_| Err("bad")), Err("bad"));
        assert_eq!(copies.clusters().all()[0].high.x, 3.0);
        assert_eq!(before.clusters().all()[0].high.x, 0.0);
        assert_ne!(copies, before);
        copies.iter_mut().for_each(|copy| copy.position.x = 0.0);
        assert_eq!(copies, before);
    }
}
