//! Pointers from the caller, checked before use.

use crate::fault::{Fault, Outcome};
use std::ffi::{CStr, c_char, c_void};
use std::mem::MaybeUninit;

/// A structure of the header that begins with its size, a `u32`. Its other fields are plain numbers
/// and pointers, valid as zeros.
pub(crate) trait Described: Copy {
    const NAME: &'static str;
    /// The size before fields were added; the present size if none were.
    const EARLIER_SIZE: usize;
}

/// Implements [`Described`]. `Name { field }` names the first field that was added: it stands where
/// the structure ended before.
macro_rules! described {
    ($($name:ident $({ $field:ident })?),* $(,)?) => {
        $(impl crate::pointers::Described for $name {
            const NAME: &'static str = stringify!($name);
            const EARLIER_SIZE: usize = crate::pointers::earlier_size!($name $($field)?);
        })*
    };
}
macro_rules! earlier_size {
    ($name:ident) => {
        size_of::<$name>()
    };
    ($name:ident $field:ident) => {
        std::mem::offset_of!($name, $field)
    };
}
pub(crate) use {described, earlier_size};

fn null(what: &str) -> Fault {
    Fault::usage(format!("the pointer to {what} is null"))
}

/// The size of the caller's structure. Fails unless it is this library's, or the earlier one.
unsafe fn checked_size<T: Described>(from: *const T) -> Outcome<usize> {
    if from.is_null() {
        return Err(null(T::NAME));
    }
    // SAFETY: the caller's structure begins with its size.
    let size = unsafe { from.cast::<u32>().read() };
    let (name, own) = (T::NAME, size_of::<T>());
    if [own, T::EARLIER_SIZE].contains(&(size as usize)) {
        return Ok(size as usize);
    }
    let message = format!(
        "the {name} says that it has {size} bytes; set its size to sizeof, which is {own} here"
    );
    Err(Fault::usage(message))
}

/// A structure of zeros that holds its size.
pub(crate) fn sized<T: Described>() -> T {
    let size = u32::try_from(size_of::<T>()).unwrap_or(u32::MAX);
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: the structure begins with its size, and zeros are valid.
    unsafe {
        value.as_mut_ptr().cast::<u32>().write(size);
        value.assume_init()
    }
}

/// A structure from the caller. Fields that were added since its size are zeros.
pub(crate) unsafe fn read<T: Described>(from: *const T) -> Outcome<T> {
    let mut value = sized::<T>();
    // SAFETY: null or the caller's, of the size that it says.
    unsafe {
        let size = checked_size(from)?;
        let to = (&raw mut value).cast::<u8>();
        to.copy_from_nonoverlapping(from.cast(), size);
    }
    Ok(value)
}

/// Structures from the caller, one behind the other, all of the size that the first one says.
pub(crate) unsafe fn read_all<T: Described>(from: *const T, count: usize) -> Outcome<Vec<T>> {
    if count == 0 {
        return Ok(Vec::new());
    }
    // SAFETY: the caller's, as many as it says.
    unsafe {
        let step = checked_size(from)?;
        let all = (0..count).map(|n| read(from.wrapping_byte_add(n * step)));
        all.collect()
    }
}

/// Fills a structure of the caller, whose size is set. The size stays as it is.
pub(crate) unsafe fn fill<T: Described>(to: *mut T, value: T) -> Outcome<()> {
    let first = size_of::<u32>();
    // SAFETY: as in `read`.
    unsafe {
        let size = checked_size(to)?;
        let from = (&raw const value).cast::<u8>().add(first);
        to.cast::<u8>()
            .add(first)
            .copy_from_nonoverlapping(from, size - first);
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

/// Writes bytes, or with a null pointer their number alone. `count` is the room, and becomes the number.
pub(crate) unsafe fn put_bytes(
    to: *mut c_void,
    count: *mut usize,
    data: impl FnOnce() -> Outcome<Vec<u8>>,
) -> Outcome<()> {
    // SAFETY: the caller's pointers; the room is as large as it says.
    unsafe {
        let room = take(count, "count")?;
        let data = data()?;
        if !to.is_null() {
            if room < data.len() {
                let message = format!("{} bytes do not fit into {room}", data.len());
                return Err(Fault::usage(message));
            }
            to.cast::<u8>()
                .copy_from_nonoverlapping(data.as_ptr(), data.len());
        }
        count.write(data.len());
    }
    Ok(())
}

/// An array from the caller; null if it is empty.
pub(crate) unsafe fn list<'a, T>(from: *const T, count: usize, what: &str) -> Outcome<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check_room(from, count, what)?;
    // SAFETY: the caller's, of so many elements, unchanged during the call.
    Ok(unsafe { std::slice::from_raw_parts(from, count) })
}

/// Fails for a null pointer, and for more elements than memory holds.
pub(crate) fn check_room<T>(at: *const T, count: usize, what: &str) -> Outcome<()> {
    if at.is_null() {
        return Err(null(what));
    }
    let bytes = count.checked_mul(size_of::<T>());
    if bytes.is_none_or(|bytes| bytes > isize::MAX as usize) {
        let message = format!("{count} {what} are more than memory holds");
        return Err(Fault::usage(message));
    }
    Ok(())
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
