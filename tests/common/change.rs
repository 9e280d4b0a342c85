//! A value with some of its fields changed.

/// Values that can be changed where they are made.
pub trait Change: Sized {
    /// The value after a change.
    fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }
}

impl<T> Change for T {}
