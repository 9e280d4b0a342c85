//! Profiles.

use crate::enums;
use crate::fault::{RevmapResult, enter};
use crate::handle::{Handle, create, handle};
use crate::pointers::{list, put, text};
use revmap::profile::Profile;
use std::ffi::{c_char, c_void};
use std::sync::Arc;

/// A profile: the solid region of the half-plane (r, z) that is turned about the axis r = 0.
/// Objects keep what they use of it.
pub struct RevmapProfile;
handle!(RevmapProfile, "profile", Arc<Profile>);

/// Makes a profile from a closed polygon: count points, each r and z in object units. The box
/// reaches from z = 0 to z = 1 and to the given radius.
///
/// Fails with REVMAP_RESULT_CONTENT for fewer than 3 points, a point with r < 0, no area, or
/// numbers that are not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_profile_from_points(
    points: *const [f64; 2],
    count: usize,
    radius: f64,
    profile: *mut *mut RevmapProfile,
) -> RevmapResult {
    create(profile, || {
        let points = list(points, count, "points")?;
        Ok(Profile::polygon(points, radius)?)
    })
}

/// Makes a profile from the content of an SVG, PNG or JPEG file, told apart by what is in it.
/// Everything darker than one half over white is solid; the picture's height is one object unit.
/// axis is a RevmapAxis.
///
/// Fails with REVMAP_RESULT_FILE if that is not possible, and with REVMAP_RESULT_CONTENT if there
/// is nothing to turn.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_profile_from_bytes(
    bytes: *const c_void,
    count: usize,
    axis: u32,
    profile: *mut *mut RevmapProfile,
) -> RevmapResult {
    create(profile, || {
        let bytes = list(bytes.cast::<u8>(), count, "bytes")?;
        Ok(revmap_files::profile_from_bytes(bytes, enums::axis(axis)?)?)
    })
}

/// Makes a profile from a file, as revmap_profile_from_bytes() does from its content. The path is
/// UTF-8.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_profile_from_file(
    path: *const c_char,
    axis: u32,
    profile: *mut *mut RevmapProfile,
) -> RevmapResult {
    create(profile, || {
        Ok(revmap_files::profile(
            text(path, "path")?,
            enums::axis(axis)?,
        )?)
    })
}

/// Returns the radius of the profile's box, object units.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_profile_radius(
    profile: *const RevmapProfile,
    radius: *mut f64,
) -> RevmapResult {
    put(radius, "radius", || Ok(RevmapProfile::get(profile)?.radius))
}

/// Destroys a profile; null is none. Objects that were made from it stay as they are.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_profile_destroy(profile: *mut RevmapProfile) -> RevmapResult {
    enter(|| RevmapProfile::destroy(profile))
}
