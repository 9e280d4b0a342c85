//! Images of the host as textures: those with the texels of a map give the map's picture. The random
//! host (`tests/soak`) changes them between frames in flight.
#![allow(unsafe_code)]

use crate::common::host::{self, Drawn, Host, Texture, opened};
use crate::common::prelude::*;
use crate::embedding::{options, three};

const SIZE: u32 = 8;

fn colors(of: impl Fn(u32, u32) -> [u8; 4]) -> Vec<[u8; 4]> {
    (0..SIZE * SIZE).map(|n| of(n % SIZE, n / SIZE)).collect()
}

fn stripes(column: u32, row: u32) -> [u8; 4] {
    [40 + 25 * column as u8, 30 + 28 * row as u8, 200, 255]
}

/// One solid.
fn close() -> Scene {
    let mut scene = three();
    scene.objects.truncate(1);
    scene
}

/// The host's picture of an object, after `change`.
fn drawn(
    host: &Host,
    device: &Device,
    object: &Object,
    change: impl FnOnce(&mut Renderer, ObjectId),
) -> Vec<u8> {
    let scene = close().with(|s| s.objects = vec![object.clone()]);
    let by = (Output::Pass(host::color_pass()), &SearchSettings::exact());
    let mut drawn = Drawn::new(host, device, options(), by, &scene);
    change(&mut drawn.renderer, drawn.ids[0]);
    drawn.picture().0
}

fn differ(a: &[u8], b: &[u8]) -> usize {
    let far = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 1);
    far.count()
}

/// An image with the texels of a map gives the map's picture; without it the map is back.
#[test]
fn images_with_the_texels_of_maps_give_their_pictures() {
    let (host, device) = opened();
    let texels = colors(stripes);
    let map = ColorMap::from_texels(SIZE, SIZE, texels.clone()).unwrap();
    let heights: Vec<f32> = (0..SIZE * SIZE)
        .map(|n| (n * 29 % 64) as f32 / 64.0)
        .collect();
    let slopes = DisplacementMap::from_heights(SIZE, SIZE, &heights, SlopeFilter::Scharr).unwrap();
    let halves: Vec<[u8; 4]> = bytemuck::pod_collect_to_vec(&slopes.encode().unwrap()[0].texels);
    let color = Texture::new(&host, vk::Format::R8G8B8A8_SRGB, &texels);
    let slope = Texture::new(&host, vk::Format::R16G16_SFLOAT, &halves);

    let mut plain = close().objects[0].clone();
    plain.texturing.bump = 0.02;
    let mut mapped = plain.clone();
    mapped.texturing.color_map = Some(Arc::new(map));
    mapped.texturing.displacement_map = Some(Arc::new(slopes));
    let without = drawn(&host, &device, &plain, |_, _| {});
    let wanted = drawn(&host, &device, &mapped, |_, _| {});
    let set = |renderer: &mut Renderer, id: ObjectId| {
        renderer.set_color_image(id, Some(color.image())).unwrap();
        renderer.set_slope_image(id, Some(slope.image())).unwrap();
    };
    let found = drawn(&host, &device, &plain, set);
    let back = drawn(&host, &device, &mapped, |renderer, id| {
        set(renderer, id);
        renderer.prewarm().unwrap();
        renderer.set_color_image(id, None).unwrap();
        renderer.set_slope_image(id, None).unwrap();
    });
    let [texture, none] = [&found, &without].map(|picture| differ(&wanted, picture));
    println!("{texture} bytes differ from the map's picture, {none} without a map");
    assert!(none > 8000, "{none}");
    // Mips are read near silhouettes, where a texel is smaller than a pixel.
    assert!(texture < none / 50, "{texture}");
    assert!(back == wanted);
}

/// An image of heights gives the picture of the map of their central differences, in both forms of
/// bumps. Read as slopes it gives another one.
#[test]
fn an_image_of_heights_gives_the_picture_of_its_slopes() {
    let (host, device) = opened();
    // Level at the upper and lower edge, where maps wrap round and the sampler does not.
    let height = |n: u32| match n / SIZE {
        0 | 1 | 6 | 7 => 0.0,
        _ => (n * 29 % 64) as f32 / 64.0,
    };
    let heights: Vec<f32> = (0..SIZE * SIZE).map(height).collect();
    let slopes = DisplacementMap::from_heights(SIZE, SIZE, &heights, SlopeFilter::Central).unwrap();
    let texels: Vec<[u8; 4]> = bytemuck::pod_collect_to_vec(&heights);
    let image = Texture::new(&host, vk::Format::R32_SFLOAT, &texels);
    for form in [BumpForm::SurfaceGradient, BumpForm::Papers] {
        let mut plain = close().objects[0].clone();
        plain.texturing.bump = 0.02;
        plain.texturing.bump_form = form;
        let mut mapped = plain.clone();
        mapped.texturing.displacement_map = Some(Arc::new(slopes.clone()));
        let wanted = drawn(&host, &device, &mapped, |_, _| {});
        let without = drawn(&host, &device, &plain, |_, _| {});
        let found = drawn(&host, &device, &plain, |renderer, id| {
            renderer.set_height_image(id, Some(image.image())).unwrap();
        });
        let misread = drawn(&host, &device, &plain, |renderer, id| {
            renderer.set_height_image(id, Some(image.image())).unwrap();
            renderer.set_slope_image(id, Some(image.image())).unwrap();
        });
        let back = drawn(&host, &device, &mapped, |renderer, id| {
            renderer.set_height_image(id, Some(image.image())).unwrap();
            renderer.prewarm().unwrap();
            renderer.set_height_image(id, None).unwrap();
        });
        let pictures = [&found, &misread, &without];
        let [of_heights, of_slopes, none] = pictures.map(|p| differ(&wanted, p));
        println!("{form:?}: {of_heights} bytes differ, {of_slopes} as slopes, {none} without");
        assert!(none > 2000 && of_slopes > 2000, "{none}, {of_slopes}");
        // Measured on lavapipe 22: 1. The map's slopes are halves, and it has mips near silhouettes.
        assert!(of_heights <= 20, "{of_heights} of {none}");
        assert!(back == wanted);
    }
}

/// Null handles and objects of other renderers are refused.
#[test]
fn wrong_images_are_refused() {
    let (host, device) = opened();
    // SAFETY: null handles are refused before they are kept.
    let null = unsafe { HostImage::new(vk::ImageView::null(), vk::Sampler::null()) };
    assert_eq!(null.unwrap_err().kind, ErrorKind::Usage);
    let exact = SearchSettings::exact();
    let color = || Output::Pass(host::color_pass());
    let [mut one, mut other] = [0, 1].map(|_| Renderer::new(&device, color(), &exact, 1).unwrap());
    let id = one.add(Object::new("vase", shapes::vase().into())).unwrap();
    let texture = Texture::new(&host, vk::Format::R8G8B8A8_SRGB, &colors(stripes));
    let error = other.set_color_image(id, Some(texture.image()));
    assert_eq!(error.unwrap_err().kind, ErrorKind::Usage);
    one.remove(id).unwrap();
    let error = one.set_slope_image(id, Some(texture.image()));
    assert_eq!(error.unwrap_err().kind, ErrorKind::Usage);
}
