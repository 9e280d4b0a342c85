//! Lists whose length follows from input or settings. Without memory for one they fail as
//! [`ErrorKind::OutOfHostMemory`]; a plain list ends the program.

use crate::error::{Error, ErrorKind, Result};
use bytemuck::{Zeroable, allocation::try_zeroed_vec};
use std::cell::Cell;

thread_local! {
    static HANDLED: Cell<bool> = const { Cell::new(false) };
}

/// True while this thread makes a request whose failure becomes an error. A program's allocator that
/// ends the program when memory ends passes the failure of such a request on.
pub fn is_handled() -> bool {
    HANDLED.get()
}

/// Makes a request whose failure becomes an error.
fn handled<R>(request: impl FnOnce() -> R) -> R {
    HANDLED.set(true);
    let result = request();
    HANDLED.set(false);
    result
}

/// An empty list with room for `count` values. `what` names them in the message of a failure.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`].
pub fn reserved<T>(count: usize, what: &str) -> Result<Vec<T>> {
    let mut values = Vec::new();
    match handled(|| values.try_reserve_exact(count)) {
        Ok(()) => Ok(values),
        Err(_) => Err(refusal::<T>(count, what)),
    }
}

/// A list of `count` equal values.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`].
pub fn filled<T: Clone>(count: usize, value: T, what: &str) -> Result<Vec<T>> {
    let mut values = reserved(count, what)?;
    values.resize(count, value);
    Ok(values)
}

/// A list of zeros, whose pages use no memory before they are written.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`].
pub fn zeroed<T: Zeroable>(count: usize, what: &str) -> Result<Vec<T>> {
    handled(|| try_zeroed_vec(count)).map_err(|()| refusal::<T>(count, what))
}

/// The list of all values.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`].
pub fn collected<T>(from: impl ExactSizeIterator<Item = T>, what: &str) -> Result<Vec<T>> {
    let mut values = reserved(from.len(), what)?;
    values.extend(from);
    Ok(values)
}

/// Adds a value to a list that grows.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`]; the list stays as it was.
pub fn push<T>(values: &mut Vec<T>, value: T, what: &str) -> Result<()> {
    if handled(|| values.try_reserve(1)).is_err() {
        return Err(refusal::<T>(values.len() + 1, what));
    }
    values.push(value);
    Ok(())
}

/// Adds values to a list that grows.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`]; the list stays as it was.
pub fn extend<T: Copy>(values: &mut Vec<T>, more: &[T], what: &str) -> Result<()> {
    if handled(|| values.try_reserve(more.len())).is_err() {
        return Err(refusal::<T>(values.len() + more.len(), what));
    }
    values.extend_from_slice(more);
    Ok(())
}

fn refusal<T>(count: usize, what: &str) -> Error {
    let mib = count.saturating_mul(size_of::<T>()) >> 20;
    let message = format!("no memory for {what} ({mib} MiB); give less or smaller input");
    Error::new(ErrorKind::OutOfHostMemory, message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_memory_holds_is_an_error() {
        const MANY: usize = 1 << 60;
        let refusals = [
            reserved::<u8>(MANY, "bytes").unwrap_err(),
            filled(MANY, 1u64, "words").unwrap_err(),
            zeroed::<u64>(usize::MAX, "words").unwrap_err(),
            collected((0..u32::MAX as usize).map(|_| [0u64; 1 << 20]), "words").unwrap_err(),
        ];
        for error in refusals {
            assert_eq!(error.kind, ErrorKind::OutOfHostMemory);
            assert!(error.to_string().starts_with("no memory for "), "{error}");
        }
        assert_eq!(filled(3, 7, "").unwrap(), [7; 3]);
        assert_eq!(zeroed::<u8>(2, "").unwrap(), [0; 2]);
        let mut list = collected([1, 2].into_iter(), "").unwrap();
        push(&mut list, 3, "").unwrap();
        extend(&mut list, &[4, 5], "").unwrap();
        assert_eq!(list, [1, 2, 3, 4, 5]);
    }
}
