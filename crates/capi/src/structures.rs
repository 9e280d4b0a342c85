//! Structures that begin with their size, from and to callers of any release.
//!
//! Later releases add members at the end of a structure. A structure within another one may grow
//! too: its own size says how far it reaches, and what follows it moves. So a structure is a list of
//! members without gaps, which is read one by one. The compiler refuses a list with a gap.

use crate::fault::{Fault, Outcome};
use std::mem::MaybeUninit;

/// A member of a structure.
pub(crate) struct Member {
    pub bytes: usize,
    /// The release that added it; 0 for the first.
    pub since: u32,
    /// The members of a structure that has a size of its own.
    pub inner: Option<&'static Layout>,
}

/// The members of a structure in the order of memory, without gaps. The first one is the size of the
/// caller's structure, a `u32`.
pub(crate) struct Layout {
    pub name: &'static str,
    pub align: usize,
    pub members: &'static [Member],
}

/// A structure of the header that begins with its size. Its other members are plain numbers and
/// pointers, valid as zeros.
pub(crate) trait Described: Copy {
    const LAYOUT: Layout;
}

/// Implements [`Described`]: `Name { 0 => [size, member, inner: Inner] 1 => [added] }` has all members
/// by the releases that added them.
macro_rules! described {
    ($($name:ident { $($since:literal => [$($field:ident $(: $inner:ident)?),* $(,)?])+ })*) => {$(
        impl crate::structures::Described for $name {
            const LAYOUT: crate::structures::Layout = crate::structures::Layout {
                name: stringify!($name),
                align: align_of::<$name>(),
                members: &[$($(crate::structures::Member {
                    bytes: crate::structures::bytes_of(|from: &$name| &from.$field),
                    since: $since,
                    inner: crate::structures::inner!($($inner)?),
                }),*),+],
            };
        }
        // Members of other systems have other alignments.
        #[cfg(target_pointer_width = "64")]
        const _: () = {
            let starts = [$($(std::mem::offset_of!($name, $field)),*),+];
            let layout = <$name as crate::structures::Described>::LAYOUT;
            assert!(
                layout.is_packed(&starts, size_of::<$name>()),
                concat!(stringify!($name), " has a gap: add a member named padding, or order its members")
            );
            // The list is complete.
            let _ = |whole: $name| {
                let $name { $($($field: _),*),+ } = whole;
            };
        };
    )*};
}
macro_rules! inner {
    () => {
        None
    };
    ($name:ident) => {
        Some(&<$name as crate::structures::Described>::LAYOUT)
    };
}
pub(crate) use {described, inner};

/// Bytes of a member.
pub(crate) const fn bytes_of<T, M>(_: fn(&T) -> &M) -> usize {
    size_of::<M>()
}

/// Most bytes of a structure that this library can read: larger sizes are no sizes.
const MOST_BYTES: usize = 4096;

impl Layout {
    /// True if each member begins where the one before ends, and the last ends with the structure.
    pub(crate) const fn is_packed(&self, starts: &[usize], bytes: usize) -> bool {
        let (mut at, mut n) = (0, 0);
        while n < starts.len() {
            if starts[n] != at {
                return false;
            }
            at += self.members[n].bytes;
            n += 1;
        }
        at == bytes && n == self.members.len()
    }

    /// Bytes of this library's structure.
    fn bytes(&self) -> usize {
        self.members.iter().map(|member| member.bytes).sum()
    }

    /// Bytes of a release's structure.
    fn bytes_at(&self, release: u32) -> usize {
        let known = self.members.iter().filter(|m| m.since <= release);
        let bytes = |member: &Member| match member.inner {
            Some(inner) => inner.bytes_at(release),
            None => member.bytes,
        };
        known.map(bytes).sum()
    }

    /// The release whose structure has so many bytes.
    fn release_of(&self, bytes: usize) -> Option<u32> {
        let since = |layout: &Self| layout.members.iter().map(|m| m.since).max();
        let inner = self.members.iter().filter_map(|m| since(m.inner?));
        let last = inner.chain(since(self)).max().unwrap_or(0);
        (0..=last).find(|&release| self.bytes_at(release) == bytes)
    }

    fn is_flat(&self) -> bool {
        self.members.iter().all(|member| member.inner.is_none())
    }

    fn wrong_size(&self, size: usize) -> Fault {
        let (name, own) = (self.name, self.bytes());
        Fault::usage(format!(
            "the {name} says that it has {size} bytes; set its size to sizeof, which is {own} here"
        ))
    }

    fn too_new(&self, size: usize) -> Fault {
        let (name, own) = (self.name, self.bytes());
        Fault::usage(format!(
            "the {name} has {size} bytes, and not only zeros after the {own} that this library reads; \
             install the library of your revmap.h"
        ))
    }

    /// The size that the caller's structure begins with. Fails for a size that none can have.
    ///
    /// # Safety
    /// `room` bytes can be read from `from` on, if the structure says as many.
    unsafe fn size(&self, from: *const u8, room: usize) -> Outcome<usize> {
        if from.is_null() {
            return Err(crate::pointers::null(self.name));
        }
        if room < size_of::<u32>() {
            return Err(self.wrong_size(room));
        }
        // SAFETY: the structure begins with its size.
        let size = unsafe { from.cast::<u32>().read_unaligned() } as usize;
        let most = room.min(MOST_BYTES);
        match size >= self.bytes_at(0) && size <= most && size.is_multiple_of(self.align) {
            true => Ok(size),
            false => Err(self.wrong_size(size)),
        }
    }

    /// Reads the caller's structure into this library's, which is zeros. Returns the bytes of the
    /// caller's.
    ///
    /// # Safety
    /// As in [`Layout::size`]; `to` has room for [`Layout::bytes`].
    unsafe fn read(&self, from: *const u8, to: *mut u8, room: usize) -> Outcome<usize> {
        // SAFETY: reads stay within the size that the structure says, writes within the members.
        unsafe {
            let size = self.size(from, room)?;
            let (mut at, mut put) = (0, 0);
            for member in self.members {
                if at == size {
                    break;
                }
                at += match member.inner {
                    Some(inner) => inner.read(from.add(at), to.add(put), size - at)?,
                    None if member.bytes > size - at => return Err(self.wrong_size(size)),
                    None => {
                        let bytes = member.bytes;
                        to.add(put).copy_from_nonoverlapping(from.add(at), bytes);
                        bytes
                    }
                };
                put += member.bytes;
            }
            if (at..size).any(|n| from.add(n).read() != 0) {
                return Err(self.too_new(size));
            }
            to.cast::<u32>().write_unaligned(self.bytes() as u32);
            Ok(size)
        }
    }

    /// Fills the caller's structure from this library's. Its size stays as it is, and its members that
    /// this library does not know become zeros.
    ///
    /// # Safety
    /// As in [`Layout::read`], the other way round.
    unsafe fn fill(&self, from: *const u8, to: *mut u8) -> Outcome<()> {
        // SAFETY: reads stay within the members, writes within the size that the structure says.
        unsafe {
            let size = self.size(to, usize::MAX)?;
            // The sizes of structures within this one are not set yet, and follow from the release.
            let release = match self.release_of(size) {
                None if self.is_flat() && size > self.bytes() => u32::MAX,
                None => return Err(self.wrong_size(size)),
                Some(release) => release,
            };
            let end = self.put(from, to, release, size);
            to.add(end).write_bytes(0, size - end);
            to.cast::<u32>().write_unaligned(size as u32);
            Ok(())
        }
    }

    /// Writes the members that a release's structure of `room` bytes has, and returns their bytes.
    unsafe fn put(&self, from: *const u8, to: *mut u8, release: u32, room: usize) -> usize {
        let (mut at, mut take) = (0, 0);
        for member in self.members {
            // SAFETY: as the caller promised.
            unsafe {
                let (from, to) = (from.add(take), to.add(at));
                match member.inner {
                    _ if at == room => break,
                    Some(inner) => at += inner.put(from, to, release, inner.bytes_at(release)),
                    None => {
                        to.copy_from_nonoverlapping(from, member.bytes);
                        at += member.bytes;
                    }
                }
            }
            take += member.bytes;
        }
        // SAFETY: every structure begins with its size.
        unsafe { to.cast::<u32>().write_unaligned(at as u32) };
        at
    }
}

/// A structure of zeros that holds its size.
pub(crate) fn sized<T: Described>() -> T {
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: the structure begins with its size, and zeros are valid.
    unsafe {
        value
            .as_mut_ptr()
            .cast::<u32>()
            .write(size_of::<T>() as u32);
        value.assume_init()
    }
}

/// A structure from the caller. Members that it does not have are zeros.
pub(crate) unsafe fn read<T: Described>(from: *const T) -> Outcome<T> {
    let mut value = sized::<T>();
    // SAFETY: null or the caller's, of the size that it says.
    unsafe { (T::LAYOUT).read(from.cast(), (&raw mut value).cast(), usize::MAX) }?;
    Ok(value)
}

/// Structures from the caller, one behind the other, all of the size that the first one says.
pub(crate) unsafe fn read_all<T: Described>(from: *const T, count: usize) -> Outcome<Vec<T>> {
    let mut all = Vec::new();
    let mut step = 0;
    for number in 0..count {
        let at = from.wrapping_byte_add(number.wrapping_mul(step));
        // SAFETY: the caller's, as many as it says.
        let (value, size) = unsafe { (read(at)?, T::LAYOUT.size(at.cast(), usize::MAX)?) };
        if number > 0 && size != step {
            return Err(Fault::usage(format!(
                "structure {number} of an array of {} has {size} bytes, and the first has {step}; \
                 set all sizes to sizeof",
                T::LAYOUT.name
            )));
        }
        step = size;
        all.push(value);
    }
    Ok(all)
}

/// Fills a structure of the caller, whose size is set.
pub(crate) unsafe fn fill<T: Described>(to: *mut T, value: T) -> Outcome<()> {
    // SAFETY: as in `read`.
    unsafe { (T::LAYOUT).fill((&raw const value).cast(), to.cast()) }
}

#[cfg(test)]
mod tests;
