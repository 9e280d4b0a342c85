//! Reads and writes frames as OpenEXR: every plane, in 32-bit floats, lossless.

use crate::{file_fault, write_atomically};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, MetaData,
    ReadChannels, ReadLayers, Text, WritableImage, read,
};
use revmap::error::Result;
use revmap::frame::{CHANNELS, Frame, pixel_count};
use revmap::host_memory;
use revmap::maps::MAX_SIDE;
use std::fs::File;
use std::io::{BufReader, Read, Seek, Write};
use std::path::Path;

/// The channel `A` in [`CHANNELS`]; `R G B` stand before it.
const ALPHA: usize = 3;

/// What needs memory, in messages.
const PLANES: &str = "the planes of a frame";

/// A layer of an EXR file.
type FloatLayer = Layer<AnyChannels<FlatSamples>>;

/// Writes all planes as 32-bit float channels, named as in [`CHANNELS`], ZIP-compressed. `R G B` are
/// multiplied by `A`, as OpenEXR has it; [`read_exr`] divides again.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File), with the file's name, if it cannot be
/// written.
pub fn write_exr(frame: &Frame, path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    let plane = |_| host_memory::reserved(frame.pixels(), PLANES);
    let planes: Result<Vec<Vec<f32>>> = CHANNELS.iter().map(plane).collect();
    let mut planes = planes.map_err(|e| e.in_file(path))?;
    for index in 0..frame.pixels() {
        let mut pixel = frame.pixel(index);
        let alpha = pixel[ALPHA];
        if alpha != 1.0 {
            pixel[..ALPHA].iter_mut().for_each(|v| *v *= alpha);
        }
        for (plane, value) in planes.iter_mut().zip(pixel) {
            plane.push(value);
        }
    }
    let attributes = LayerAttributes {
        software_name: Text::new_or_none("revmap"),
        ..LayerAttributes::default()
    };
    let channels = CHANNELS.into_iter().zip(planes);
    let layer = layer([frame.width, frame.height], attributes, channels);
    write_atomically(path, |writer| {
        write_layer(layer, writer).map_err(|e| file_fault(format!("cannot be written: {e}")))
    })
}

/// A layer of 32-bit float channels, ZIP-compressed.
pub(crate) fn layer<'a>(
    [width, height]: [u32; 2],
    attributes: LayerAttributes,
    channels: impl IntoIterator<Item = (&'a str, Vec<f32>)>,
) -> FloatLayer {
    let channel = |(name, values)| AnyChannel::new(name, FlatSamples::F32(values));
    let channels = channels.into_iter().map(channel).collect();
    Layer::new(
        (width as usize, height as usize),
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels),
    )
}

/// Writes a file of one layer; the error is one line.
pub(crate) fn write_layer(
    layer: FloatLayer,
    writer: &mut (impl Write + Seek + ?Sized),
) -> std::result::Result<(), String> {
    let image = Image::from_layer(layer);
    let written = image.write().non_parallel().to_buffered(writer);
    written.map_err(|e| one_line(&e))
}

/// Reads a frame that [`write_exr`] wrote, or any file whose first layer holds its channels. `R G B`
/// are divided by `A` where that is above 0.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File), with the file's name, if it cannot be read
/// or lacks a channel, which is the key; the errors of [`Frame::new`].
pub fn read_exr(path: impl AsRef<Path>) -> Result<Frame> {
    let path = path.as_ref();
    read_checked(path).map_err(|e| e.in_file(path))
}

fn read_checked(path: &Path) -> Result<Frame> {
    let unreadable = |e: String| file_fault(format!("cannot be read as EXR: {e}"));
    let file = || match File::open(path) {
        Ok(file) => Ok(BufReader::new(file)),
        Err(e) => Err(unreadable(one_line(&e.into()))),
    };
    let length = std::fs::metadata(path).map_or(0, |file| file.len());
    // The header is read first: its size determines the reader's allocations.
    let sizes = layer_sizes(file()?, length).map_err(unreadable)?;
    for [width, height] in sizes {
        pixel_count(width, height)?;
    }
    let layer = first_layer(file()?).map_err(unreadable)?;
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let (width, height) = (side(layer.size.width()), side(layer.size.height()));
    let mut frame = Frame::new(width, height, [0.0; 4])?;
    let mut planes: Vec<Vec<f32>> = Vec::with_capacity(CHANNELS.len());
    for name in CHANNELS {
        let mut channels = layer.channel_data.list.iter();
        let channel = channels.find(|c| c.name.eq(name)).ok_or_else(|| {
            file_fault("there is no such channel; give a file that revmap wrote").at_key(name)
        })?;
        let mut plane: Vec<f32> = host_memory::reserved(channel.sample_data.len(), PLANES)?;
        plane.extend(channel.sample_data.values_as_f32());
        if plane.len() != frame.pixels() {
            let message = "the channel is subsampled; write it at full size";
            return Err(file_fault(message).at_key(name));
        }
        planes.push(plane);
    }
    (0..frame.pixels()).for_each(|index| {
        let mut pixel: [f32; 17] = std::array::from_fn(|c| planes[c][index]);
        let alpha = pixel[ALPHA];
        if alpha > 0.0 && alpha != 1.0 {
            pixel[..ALPHA].iter_mut().for_each(|v| *v /= alpha);
        }
        frame.set_pixel(index, pixel);
    });
    Ok(frame)
}

/// More than this times a file's length no compressor of EXR brings out of it.
const MOST_PACKED: u64 = 1 << 14;

/// Sizes of the layers of an EXR file of `length` bytes, by its header. Layers that are larger than
/// any picture, or than such a file can hold, are refused before the reader allocates them.
pub(crate) fn layer_sizes(
    file: impl Read + Seek,
    length: u64,
) -> std::result::Result<Vec<[u32; 2]>, String> {
    let meta = MetaData::read_from_buffered(file, false).map_err(|e| one_line(&e))?;
    let size = |header: &exr::meta::header::Header| {
        let size = header.layer_size;
        let (width, height) = (size.width() as u64, size.height() as u64);
        if width.max(height) > u64::from(MAX_SIDE) {
            return Err(format!(
                "it has {width} x {height} pixels; {MAX_SIDE} x {MAX_SIDE} is the most"
            ));
        }
        let promised = 4 * width * height * header.channels.list.len() as u64;
        if promised > MOST_PACKED.saturating_mul(length) {
            return Err(format!(
                "its {length} bytes cannot hold the {width} x {height} pixels that it names"
            ));
        }
        Ok([width as u32, height as u32]) // at most MAX_SIDE
    };
    meta.headers.iter().map(size).collect()
}

/// The first layer of an EXR file, with all its channels.
pub(crate) fn first_layer(file: impl Read + Seek) -> std::result::Result<FloatLayer, String> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(file);
    image.map(|i| i.layer_data).map_err(|e| one_line(&e))
}

fn one_line(error: &exr::error::Error) -> String {
    match error {
        exr::error::Error::Io(e) if e.kind() == std::io::ErrorKind::StorageFull => {
            "the disk is full; free some space".into()
        }
        exr::error::Error::Io(e) if e.kind() == std::io::ErrorKind::NotFound => {
            "there is no such file".into()
        }
        other => other.to_string().replace('\n', " "),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn saved(frame: &Frame) -> (tempfile::TempDir, std::path::PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        write_exr(frame, &path).unwrap();
        (folder, path)
    }

    #[test]
    fn colours_are_multiplied_by_alpha_in_the_file_alone() {
        let mut frame = Frame::new(3, 1, [0.2, 0.4, 0.6, 0.0]).unwrap();
        frame.color[1] = [0.9, 3.0, 0.5, 0.25];
        frame.color[2] = [0.9, 3.0, 0.5, 1.0];
        let (_folder, path) = saved(&frame);
        let layer = first_layer(BufReader::new(File::open(&path).unwrap())).unwrap();
        let channels = &layer.channel_data.list;
        for (name, wanted) in [
            ("R", [0.0, 0.225, 0.9]),
            ("G", [0.0, 0.75, 3.0]),
            ("A", [0.0, 0.25, 1.0]),
        ] {
            let channel = channels.iter().find(|c| c.name.eq(name)).unwrap();
            assert!(channel.sample_data.values_as_f32().eq(wanted), "{name}");
        }
        let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
        let mut expected = CHANNELS.map(String::from).to_vec();
        expected.sort();
        assert_eq!(names, expected);
        // A colour that nothing shows is lost.
        let read = read_exr(&path).unwrap();
        assert_eq!(read.color, [[0.0; 4], frame.color[1], frame.color[2]]);
    }

    #[test]
    fn every_bit_comes_back_and_damage_is_named() {
        let mut frame = Frame::new(37, 21, [0.0; 4]).unwrap();
        for index in (0..frame.pixels()).step_by(3) {
            let mut pixel = std::array::from_fn(|c| (index * 17 + c) as f32 * 0.731 - 40.0);
            pixel[ALPHA] = 1.0;
            frame.set_pixel(index, pixel);
        }
        let (folder, good) = saved(&frame);
        assert_eq!(read_exr(&good).unwrap().first_difference(&frame), None);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let bytes = std::fs::read(&good).unwrap();
        let bad = folder.path().join("bad.exr");
        for cut in [0, 3, 100, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(&bad, &bytes[..cut]).unwrap();
            let error = read_exr(&bad).unwrap_err().to_string();
            assert!(error.starts_with(bad.to_str().unwrap()), "{error}");
        }
        let error = read_exr(folder.path().join("none.exr")).unwrap_err();
        assert!(error.to_string().contains("no such file"), "{error}");
        exr::prelude::write_rgb_file(&bad, 4, 4, |_, _| (0.0f32, 0.0f32, 0.0f32)).unwrap();
        assert_eq!(read_exr(&bad).unwrap_err().key.as_deref(), Some("A"));
    }
}
