//! Ten further releases, in which structures grow by a member at a time, against programs of each.
#![allow(clippy::panic, clippy::unwrap_used)]

use super::*;
use crate::fault::RevmapResult;

const LAST: u32 = 10;

/// The structures of the library of a release: one that grows in even releases; one that holds it,
/// followed by a member, and grows in odd releases. Both grow in release 6.
fn layouts(release: u32) -> [&'static Layout; 2] {
    let member = |bytes, since| Member {
        bytes,
        since,
        inner: None,
    };
    let layout = |name, members: Vec<Member>| -> &'static Layout {
        let known = members.into_iter().filter(|m| m.since <= release);
        Box::leak(Box::new(Layout {
            name,
            align: 8,
            members: known.collect::<Vec<_>>().leak(),
        }))
    };
    let first = || vec![member(4, 0), member(4, 0), member(8, 0)];
    let added = |is_added: fn(u32) -> bool| {
        let releases = (1..=LAST).filter(move |r| is_added(*r));
        releases.map(move |r| member(8, r))
    };
    let flat = first().into_iter().chain(added(|r| r % 2 == 0));
    let flat = layout("Flat", flat.collect());
    let inner = Member {
        bytes: flat.bytes(),
        since: 0,
        inner: Some(flat),
    };
    let outer = first().into_iter().chain([inner, member(8, 0)]);
    let outer = outer.chain(added(|r| r % 2 == 1 || r == 6));
    [flat, layout("Outer", outer.collect())]
}

/// The structure of a release in memory, whose members up to another release have values.
fn image_of(layout: &Layout, release: u32, known: u32) -> Vec<u8> {
    let mut out = Vec::new();
    for (number, member) in layout.members.iter().enumerate() {
        if member.since > release {
            continue;
        }
        let value = match number {
            0 => layout.bytes_at(release) as u64,
            1 => 0, // padding
            _ if member.since > known => 0,
            _ => 0x0101_0101 * (number as u64 + 1),
        };
        match member.inner {
            Some(inner) => out.extend(image_of(inner, release, known)),
            None => out.extend(&value.to_ne_bytes()[..member.bytes]),
        }
    }
    out
}

fn read_as(layout: &Layout, from: &[u8]) -> Outcome<Vec<u8>> {
    let mut to = vec![0; layout.bytes()];
    // SAFETY: both are as long as their layouts say.
    unsafe { layout.read(from.as_ptr(), to.as_mut_ptr(), usize::MAX) }?;
    Ok(to)
}

/// What a program of another layout gets from a structure in memory. Bytes behind stay as they are.
fn filled_by(layout: &Layout, from: &[u8], theirs: &Layout) -> Outcome<Vec<u8>> {
    let bytes = theirs.bytes();
    let mut to = vec![0xa5; bytes + 64];
    to[..4].copy_from_slice(&(bytes as u32).to_ne_bytes());
    // SAFETY: as above.
    unsafe { layout.fill(from.as_ptr(), to.as_mut_ptr()) }?;
    assert!(to[bytes..].iter().all(|byte| *byte == 0xa5), "bytes behind");
    to.truncate(bytes);
    Ok(to)
}

fn refused<T>(outcome: Outcome<T>, part: &str) {
    let Err(fault) = outcome else {
        panic!("taken, not refused for {part}");
    };
    assert_eq!(fault.result, RevmapResult::Usage);
    assert!(fault.text.contains(part), "{}", fault.text);
}

#[test]
fn programs_of_ten_releases_work_with_libraries_of_ten_releases() {
    let whole = layouts(LAST);
    let cut = |which: usize, release: u32, known: u32| {
        image_of(whole[which], release, known.min(release))
    };
    for ours in 0..=LAST {
        let library = layouts(ours);
        for theirs in 0..=LAST {
            let program = layouts(theirs);
            for (which, name) in [(0, "Flat"), (1, "Outer")] {
                let [layout, other] = [library[which], program[which]];
                let case = format!("{name} of release {theirs} in a library of release {ours}");
                let (sent, read) = (cut(which, theirs, LAST), cut(which, ours, theirs));
                assert_eq!(sent.len(), other.bytes());
                if sent.len() <= read.len() {
                    assert_eq!(read_as(layout, &sent).unwrap(), read, "{case}");
                    let own = cut(which, ours, LAST);
                    let got = filled_by(layout, &own, other).unwrap();
                    assert_eq!(got, sent, "{case}");
                    continue;
                }
                // A later program: taken if it uses nothing new.
                refused(read_as(layout, &sent), "install the library");
                let plain = cut(which, theirs, ours);
                assert_eq!(read_as(layout, &plain).unwrap(), read, "{case}");
                let got = filled_by(layout, &cut(which, ours, LAST), other);
                match which {
                    0 => assert_eq!(got.unwrap(), plain, "{case}"),
                    _ => refused(got, "Outer says that it has"),
                }
            }
        }
    }
}

#[test]
fn sizes_that_no_release_has_are_refused() {
    let [flat, outer] = layouts(LAST);
    for (layout, name) in [(flat, "Flat"), (outer, "Outer")] {
        let own = image_of(layout, LAST, LAST);
        let mut sent = own.clone();
        sent.resize(8192, 0);
        for size in [
            0,
            4,
            8,
            layout.bytes_at(0) - 8,
            own.len() - 4,
            own.len() + 4,
            4104,
            usize::MAX,
        ] {
            sent[..4].copy_from_slice(&(size as u32).to_ne_bytes());
            refused(read_as(layout, &sent), &format!("{name} says that it has"));
            // SAFETY: larger than any size that is taken.
            let result = unsafe { layout.fill(own.as_ptr(), sent.as_mut_ptr()) };
            refused(result, &format!("{name} says that it has"));
        }
    }
    // A structure within another one that reaches beyond it, and one without a size.
    let mut sent = image_of(outer, 0, 0);
    for size in [0u32, 12, 64] {
        sent[16..20].copy_from_slice(&size.to_ne_bytes());
        refused(read_as(outer, &sent), "Flat says that it has");
    }
}

#[test]
fn gaps_between_members_are_found() {
    let member = |bytes| Member {
        bytes,
        since: 0,
        inner: None,
    };
    let members: &[Member] = vec![member(4), member(8), member(4)].leak();
    let layout = Layout {
        name: "Gap",
        align: 4,
        members,
    };
    assert!(layout.is_packed(&[0, 4, 12], 16));
    assert!(!layout.is_packed(&[0, 8, 16], 24), "a gap within");
    assert!(!layout.is_packed(&[0, 4, 12], 24), "a gap at the end");
}
