//! Tables of what others keep alive.

use crate::error::Result;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Weak};

/// Values by key, as long as somebody holds them.
pub(crate) struct Kept<K, V>(HashMap<K, Weak<V>>);

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<K: Hash + Eq, V> Kept<K, V> {
    /// The value of a key, if somebody holds it.
    pub fn known(&self, key: &K) -> Option<Arc<V>> {
        self.0.get(key).and_then(Weak::upgrade)
    }

    /// Notes a new value, and forgets the dead where the table would grow.
    pub fn keep(&mut self, key: K, value: V) -> Arc<V> {
        if self.0.len() == self.0.capacity() {
            self.0.retain(|_, known| known.strong_count() > 0);
        }
        let made = Arc::new(value);
        self.0.insert(key, Arc::downgrade(&made));
        made
    }

    /// The value of a key, made now where nobody holds it.
    pub fn get(&mut self, key: K, make: impl FnOnce() -> Result<V>) -> Result<Arc<V>> {
        match self.known(&key) {
            Some(known) => Ok(known),
            None => Ok(self.keep(key, make()?)),
        }
    }

    /// All values that somebody holds.
    pub fn living(&self) -> impl Iterator<Item = Arc<V>> + '_ {
        self.0.values().filter_map(Weak::upgrade)
    }
}
