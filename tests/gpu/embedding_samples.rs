//! Several samples in a host's pass: a ray through each makes silhouettes as smooth as the samples,
//! and leaves no sample of a solid to what is behind it.
#![allow(unsafe_code)]

use crate::common::host::{self, Drawn, opened};
use crate::common::prelude::*;
use crate::embedding::{options, three};
use revmap::frame::linear_from_srgb;
use revmap_offscreen::samples::averaged;

/// Solids, copies and pixels of one copy, before what a canvas is cleared to.
fn scenes() -> Vec<(&'static str, Scene)> {
    let three = || three().with(|s| s.background = [0.0, 0.0, 0.0, 1.0]);
    let mut small = three();
    let spot = |n: u32| {
        let (x, y) = (f64::from(n / 20), f64::from(n % 20));
        scaled([0.16 * x - 1.2, 0.16 * y - 1.5, 0.0], 0.1)
    };
    small.objects.truncate(1);
    small.objects[0].instances = (0..300).map(spot).collect();
    vec![("three", three()), ("copies", small)]
}

/// The host's picture by four samples.
fn picture(host: &host::Host, device: &Device, scene: &Scene, sample_rays: bool) -> Frame {
    let options = options();
    let output = Output::Pass(PassFormats {
        samples: 4,
        sample_rays,
        ..host::color_pass()
    });
    let by = (output, &SearchSettings::exact());
    let (bytes, _) = Drawn::new(host, device, options, by, scene).picture();
    let mut frame = Frame::new(options.width, options.height, [0.0; 4]).unwrap();
    let linear = |byte: u8| linear_from_srgb(f64::from(byte) / 255.0) as f32;
    for (color, rgba) in frame.color.iter_mut().zip(bytes.as_chunks::<4>().0) {
        *color = [linear(rgba[0]), linear(rgba[1]), linear(rgba[2]), 1.0];
    }
    frame
}

/// The picture of so many rays a pixel.
fn rays(scene: &Scene, count: u32) -> Frame {
    let settings = Settings {
        stage: DrawStage::Fragment,
        planes: Planes::Color,
        antialias: false,
        ..sized(options().width, options().height)
    };
    averaged(count, scene, |shifted| Ok(draw(shifted, &settings))).unwrap()
}

fn rms(truth: &Frame, frame: &Frame) -> f32 {
    let colors = truth.color.iter().zip(&frame.color);
    let squares = colors.flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).powi(2)));
    (squares.sum::<f32>() / truth.color.len() as f32).sqrt()
}

fn largest(truth: &Frame, frame: &Frame) -> f32 {
    let colors = truth.color.iter().zip(&frame.color);
    let apart = colors.flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).abs()));
    apart.fold(0.0, f32::max)
}

/// Look-ups of samples are counted in their own pixel: none more than a pixel beside those of one
/// ray, for rays through samples pass at most half a pixel beside its middle.
#[test]
fn steps_stay_in_their_pixel() {
    let mut scene = three();
    scene.objects.truncate(1);
    let settings = sized(options().width, options().height);
    let steps = |samples| {
        let options = OffscreenOptions::default().with(|o| o.samples = samples);
        let mut made = Offscreen::with(device(), &scene, &settings, options).unwrap();
        made.draw().unwrap();
        made.read().unwrap().steps
    };
    let (one, four) = (steps(1), steps(4));
    let ends = |steps: &[f32]| {
        let width = options().width as usize;
        let columns = (0..width).filter(|x| steps.iter().skip(*x).step_by(width).any(|s| *s > 0.0));
        let columns: Vec<_> = columns.collect();
        [columns[0], columns[columns.len() - 1]]
    };
    let ([left, right], [first, last]) = (ends(&one), ends(&four));
    println!("columns {left} to {right}, by four samples {first} to {last}");
    assert!((left - 1..=left).contains(&first) && (right..=right + 1).contains(&last));
    let sum = |steps: &[f32]| steps.iter().sum::<f32>();
    assert!(sum(&four) > 3.0 * sum(&one));
}

/// Rays through samples come much nearer to 64 rays than one ray for all samples, and no pixel is
/// far off.
#[test]
fn rays_through_samples_smooth_silhouettes() {
    let (host, own) = opened();
    for (name, scene) in scenes() {
        let truth = rays(&scene, 64);
        let [one, each] = [false, true].map(|rays| picture(&host, &own, &scene, rays));
        let four = rays(&scene, 4);
        let [one_off, each_off, four_off] = [&one, &each, &four].map(|frame| rms(&truth, frame));
        let largest = largest(&truth, &each);
        println!(
            "{name}: rms {one_off:.4}, through samples {each_off:.4} (four rays {four_off:.4}), largest {largest:.3}"
        );
        assert!(
            each_off < 0.4 * one_off && each_off < 1.1 * four_off,
            "{name}"
        );
        // No pixel is farther off than a quarter of it.
        assert!(largest < 0.25, "{name}: {largest}");
    }
}
