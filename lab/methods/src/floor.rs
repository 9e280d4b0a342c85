//! The floor: a frame of the default search in which nothing is searched. Each pixel returns its
//! first possible point: on the hull's triangle, or where its ray enters the bounding cylinder. All
//! else is as in the frame itself, so what a search takes is its time above the floor.
//!
//! Its shaders, compiled with the feature `shaderc`, are the renderer's but for `shaders/floor/`.

use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::Device;
use revmap::scene::{Scene, Shadow};

include!(concat!(env!("OUT_DIR"), "/floor.rs"));

/// Whether the program was built with it.
pub fn is_available() -> bool {
    !MODULES.is_empty()
}

/// The device with the floor's shaders in place of the search's.
///
/// # Errors
/// [`ErrorKind::Usage`] where the program was built without `shaderc`; of Vulkan.
pub fn device(device: &Device) -> Result<Device> {
    if !is_available() {
        return refused("this program was built without the feature `shaderc`, which compiles it");
    }
    // SAFETY: the shaders have the renderer's own includes, so their interface is the same.
    #[allow(unsafe_code)]
    unsafe {
        device.with_shaders(Box::new(words))
    }
}

/// What the floor is not made for.
///
/// # Errors
/// [`ErrorKind::Usage`] for shadows and for replicas.
pub fn check(scene: &Scene) -> Result<()> {
    if scene.shadow == Shadow::Off && scene.objects.iter().all(|o| o.repeat == [1; 3]) {
        return Ok(());
    }
    refused("it is measured of solids without shadows and replicas")
}

fn refused<T>(why: &str) -> Result<T> {
    Err(Error::new(ErrorKind::Usage, format!("no floor: {why}")).at_key("solver"))
}

/// The floor's module in place of a search's; `None` of boxes' vertices and of lists of tiles.
fn words(file: &str, macros: &[(&str, &str)]) -> Result<Option<Vec<u32>>> {
    let of = |name: &str| macros.iter().find(|(n, _)| *n == name).map(|(_, v)| *v);
    if file != "proxy_cells.vert" && (file.ends_with(".vert") || of("SEARCH").is_none()) {
        return Ok(None);
    }
    // Contours that do not close are drawn by another search, whose vertices pass other values.
    if of("SEARCH").is_some_and(|search| search != "SEARCH_QUADRIC") {
        return refused("the default search cannot draw an object, and another takes its place");
    }
    let output = of("OUTPUT").unwrap_or("OUTPUT_COLOR");
    let name = format!("{file} {output}");
    match MODULES.iter().find(|(known, _)| *known == name) {
        Some((_, words)) => Ok(Some(words.to_vec())),
        None => refused(&format!("there is no {name}")),
    }
}
