//! Handles: numbers that C holds instead of addresses.
//!
//! Each number is used once, so that a destroyed handle is never mistaken for another.

use crate::fault::{Fault, Outcome, RevmapResult, enter};
use crate::pointers::put;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock, RwLockWriteGuard, TryLockError};

/// The values behind the live handles of one kind, by their numbers.
pub(crate) type Registry<T> = RwLock<BTreeMap<usize, T>>;

/// The handle's type in the header.
pub(crate) trait Handle: Sized + 'static {
    /// The value behind a handle. Clones refer to the same object.
    type Value: Clone + 'static;
    /// The name in messages.
    const NAME: &'static str;
    fn registry() -> &'static Registry<Self::Value>;

    /// A new handle.
    fn create(value: Self::Value) -> *mut Self {
        // Numbers grow in steps like those of addresses, so that tools that check alignment report
        // nothing.
        static NEXT: AtomicUsize = AtomicUsize::new(16);
        let number = NEXT.fetch_add(16, Ordering::Relaxed);
        write(Self::registry()).insert(number, value);
        std::ptr::without_provenance_mut(number)
    }

    fn get(handle: *const Self) -> Outcome<Self::Value> {
        let live = Self::registry().read();
        let live = live.unwrap_or_else(PoisonError::into_inner);
        let found = live.get(&handle.addr()).cloned();
        found.ok_or_else(|| missing(Self::NAME, handle.is_null()))
    }

    /// The result of `get`; `None` for a null handle.
    fn get_optional(handle: *const Self) -> Outcome<Option<Self::Value>> {
        if handle.is_null() {
            return Ok(None);
        }
        Self::get(handle).map(Some)
    }

    /// Removes a handle. A null handle is accepted.
    fn destroy(handle: *mut Self) -> Outcome<()> {
        if handle.is_null() {
            return Ok(());
        }
        let value = write(Self::registry()).remove(&handle.addr());
        // The value is dropped without the lock, since that may take long.
        value.map(drop).ok_or_else(|| missing(Self::NAME, false))
    }
}

fn missing(name: &str, null: bool) -> Fault {
    let why = match null {
        true => "is null",
        false => "was destroyed, or never was one",
    };
    Fault::new(RevmapResult::Handle, format!("the {name} {why}"))
}

fn write<T>(registry: &Registry<T>) -> RwLockWriteGuard<'_, BTreeMap<usize, T>> {
    registry.write().unwrap_or_else(PoisonError::into_inner)
}

/// The body of an entry point that makes a handle.
pub(crate) unsafe fn create<H: Handle, V: Into<H::Value>>(
    to: *mut *mut H,
    value: impl FnOnce() -> Outcome<V>,
) -> RevmapResult {
    // SAFETY: the caller's pointer.
    unsafe { put(to, H::NAME, || Ok(H::create(value()?.into()))) }
}

/// Calls `work` with the value of a handle that one thread at a time may use.
pub(crate) fn with<H: Handle<Value = Arc<Mutex<T>>>, T: 'static, R>(
    handle: *const H,
    work: impl FnOnce(&mut T) -> Outcome<R>,
) -> Outcome<R> {
    let (name, shared) = (H::NAME, H::get(handle)?);
    match shared.try_lock() {
        Ok(mut value) => work(&mut value),
        Err(TryLockError::WouldBlock) => Err(Fault::new(
            RevmapResult::Busy,
            format!("the {name} is in use by another thread; use it in one at a time"),
        )),
        Err(TryLockError::Poisoned(_)) => Err(Fault::new(
            RevmapResult::Internal,
            format!("the {name} has met a fault of the library before; destroy it"),
        )),
    }
}

/// The body of an entry point that works with such a value.
pub(crate) fn enter_with<H: Handle<Value = Arc<Mutex<T>>>, T: 'static>(
    handle: *const H,
    work: impl FnOnce(&mut T) -> Outcome<()>,
) -> RevmapResult {
    enter(|| with(handle, work))
}

/// Declares the type of a handle.
macro_rules! handle {
    ($name:ident, $text:literal, $value:ty) => {
        impl crate::handle::Handle for $name {
            type Value = $value;
            const NAME: &'static str = $text;

            fn registry() -> &'static crate::handle::Registry<$value> {
                static LIVE: crate::handle::Registry<$value> =
                    std::sync::RwLock::new(std::collections::BTreeMap::new());
                &LIVE
            }
        }
    };
}
pub(crate) use handle;

#[cfg(test)]
mod tests {
    use super::*;

    struct Thing;
    handle!(Thing, "thing", Arc<Mutex<u32>>);

    #[test]
    fn handles_are_found_until_they_are_destroyed() {
        let shared = Arc::new(Mutex::new(7));
        let first = Thing::create(shared.clone());
        let second = Thing::create(shared.clone());
        assert_ne!(first, second);
        assert!(Arc::ptr_eq(&Thing::get(first).unwrap(), &shared));
        Thing::destroy(first).unwrap();
        for wrong in [first, std::ptr::null_mut()] {
            assert_eq!(Thing::get(wrong).unwrap_err().result, RevmapResult::Handle);
        }
        let again = Thing::destroy(first).unwrap_err().result;
        assert_eq!(again, RevmapResult::Handle);
        assert!(Thing::destroy(std::ptr::null_mut()).is_ok());
        assert!(Thing::get_optional(std::ptr::null()).unwrap().is_none());
        assert!(Thing::get_optional(first).is_err());
        Thing::destroy(second).unwrap();
        assert_eq!(Arc::strong_count(&shared), 1);
    }

    #[test]
    fn two_threads_at_once_are_refused() {
        let shared = Thing::create(Arc::new(Mutex::new(0)));
        let number = shared.addr();
        let other = move || {
            let same = std::ptr::without_provenance::<Thing>(number);
            with(same, |_| Ok(())).unwrap_err().result
        };
        let inner = with(shared, |_| Ok(std::thread::spawn(other).join()));
        assert_eq!(inner.unwrap().unwrap(), RevmapResult::Busy);
        assert!(with(shared, |_| Ok(())).is_ok());
        Thing::destroy(shared).unwrap();
    }
}
