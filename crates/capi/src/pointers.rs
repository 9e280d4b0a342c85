//! Pointers from the caller, checked before use.

use crate::fault::{Fault, Outcome};
use std::ffi::{CStr, c_char};

/// A structure of the header that begins with its size, a `u32`.
pub(crate) trait Described: Copy {
    const NAME: &'static str;
}

/// Implements [`Described`].
macro_rules! described {
    ($($name:ident),* $(,)?) => {
        $(impl crate::pointers::Described for $name {
            const NAME: &'static str = stringify!($name);
        })*
    };
}
pub(crate) use described;

fn null(what: &str) -> Fault {
    Fault::usage(format!("the pointer to {what} is null"))
}

/// Fails unless `from` is a structure of this library's size.
unsafe fn check_size<T: Described>(from: *const T) -> Outcome<()> {
    if from.is_null() {
        return Err(null(T::NAME));
    }
    // SAFETY: the caller's structure begins with its size.
    let size = unsafe { from.cast::<u32>().read() };
    let (name, own) = (T::NAME, size_of::<T>());
    if size as usize == own {
        return Ok(());
    }
    let message = format!(
        "the {name} says that it has {size} bytes; set its size to sizeof, which is {own} here"
    );
    Err(Fault::usage(message))
}

/// A structure from the caller.
pub(crate) unsafe fn read<T: Described>(from: *const T) -> Outcome<T> {
    // SAFETY: null or the caller's, of the size that it says.
    unsafe {
        check_size(from)?;
        Ok(from.read())
    }
}

/// Fills a structure of the caller, whose size is set.
pub(crate) unsafe fn fill<T: Described>(to: *mut T, value: T) -> Outcome<()> {
    // SAFETY: as in `read`.
    unsafe {
        check_size(to)?;
        to.write(value);
    }
    Ok(())
}

/// Writes a value that has no size of its own.
pub(crate) unsafe fn put<T>(
    to: *mut T,
    what: &str,
    value: impl FnOnce() -> Outcome<T>,
) -> Outcome<()> {
    if to.is_null() {
        return Err(null(what));
    }
    let value = value()?;
    // SAFETY: the caller's, for one value.
    unsafe { to.write(value) };
    Ok(())
}

/// A value from the caller without a size of its own.
pub(crate) unsafe fn take<T: Copy>(from: *const T, what: &str) -> Outcome<T> {
    // SAFETY: null or the caller's.
    unsafe { from.as_ref() }.copied().ok_or_else(|| null(what))
}

/// An array from the caller; null if it is empty.
pub(crate) unsafe fn list<'a, T>(from: *const T, count: usize, what: &str) -> Outcome<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    if from.is_null() {
        return Err(null(what));
    }
    let bytes = count.checked_mul(size_of::<T>());
    if bytes.is_none_or(|bytes| bytes > isize::MAX as usize) {
        let message = format!("{count} {what} are more than memory holds");
        return Err(Fault::usage(message));
    }
    // SAFETY: the caller's, of so many elements, unchanged during the call.
    Ok(unsafe { std::slice::from_raw_parts(from, count) })
}

/// A text from the caller.
pub(crate) unsafe fn text<'a>(from: *const c_char, what: &str) -> Outcome<&'a str> {
    if from.is_null() {
        return Err(null(what));
    }
    // SAFETY: the caller's, ended by 0, unchanged during the call.
    let text = unsafe { CStr::from_ptr(from) };
    text.to_str()
        .map_err(|_| Fault::usage(format!("the {what} is not UTF-8")))
}
