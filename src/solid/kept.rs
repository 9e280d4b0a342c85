//! Tables of shared values that do not keep them alive.

use crate::error::Result;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Weak};

/// Weak references by key: a value stays as long as an owner holds it elsewhere.
pub(crate) struct Kept<K, V>(HashMap<K, Weak<V>>);

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<K: Hash + Eq, V> Kept<K, V> {
    /// The value of a key, if it is alive.
    pub fn known(&self, key: &K) -> Option<Arc<V>> {
        self.0.get(key).and_then(Weak::upgrade)
    }

    /// Adds a new value. Removes dead entries first if the table would grow.
    pub fn keep(&mut self, key: K, value: V) -> Arc<V> {
        if self.0.len() == self.0.capacity() {
            self.0.retain(|_, known| known.strong_count() > 0);
        }
        let made = Arc::new(value);
        self.0.insert(key, Arc::downgrade(&made));
        made
    }

    /// The value of a key; made now if it is not alive.
    pub fn get(&mut self, key: K, make: impl FnOnce() -> Result<V>) -> Result<Arc<V>> {
        match self.known(&key) {
            Some(known) => Ok(known),
            None => Ok(self.keep(key, make()?)),
        }
    }

    /// All values that are alive.
    pub fn living(&self) -> impl Iterator<Item = Arc<V>> + '_ {
        self.0.values().filter_map(Weak::upgrade)
    }
}
