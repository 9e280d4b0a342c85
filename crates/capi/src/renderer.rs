//! Renderers: objects recorded into a host's command buffers.

pub mod frame;
pub mod objects;
pub mod statistics;

use crate::device::RevmapDevice;
use crate::enums::{self, RevmapPassKind};
use crate::fault::{Fault, Outcome, RevmapResult, enter};
use crate::handle::{Handle, create, enter_with, handle, with};
use crate::pointers::{list, put};
use crate::shading::RevmapShading;
use crate::structures::{described, read};
use crate::values::{RevmapLighting, RevmapSearch};
use ash::vk;
use revmap::gpu::{
    ComputeTarget, DepthOrder, DepthTest, HostPass, HostShading, Output, PassFormats, PassKind,
    PreparedFrame, Renderer, SlopeBias,
};
use revmap::settings::{PlaneList, Planes};
use std::ffi::CString;
use std::sync::{Arc, Mutex};

/// Objects on a device, drawn into the host's targets, with several frames in flight, which use
/// slots in turn. The renderer must not be destroyed before the frames that it recorded are done.
pub struct RevmapRenderer;
handle!(RevmapRenderer, "renderer", Arc<Mutex<Recorder>>);

/// A renderer and the prepared frames of its slots.
pub(crate) struct Recorder {
    renderer: Renderer,
    /// True if it draws fragments in a pass.
    in_pass: bool,
    /// The frame that each slot was prepared for.
    prepared: Vec<Option<PreparedFrame>>,
    /// The renderer's notes that the caller has read.
    notes: Vec<CString>,
}

/// The pass in which fragments are drawn.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RevmapPass {
    /// sizeof(RevmapPass).
    pub size: u32,
    /// A RevmapPassKind.
    pub kind: u32,
    /// Samples of every attachment: 1, 2, 4 or 8. Rays go through pixel centres with any number,
    /// unless sample_rays says otherwise.
    pub samples: u32,
    /// A RevmapDepthOrder.
    pub depth_order: u32,
    /// A RevmapPlanes: what the fragment shader writes, one plane an attachment.
    pub planes: u32,
    /// For a render pass: the subpass, which has a depth attachment.
    pub subpass: u32,
    /// For a render pass: the pass. The pass must live as long as the renderer. Passes that are
    /// compatible with it may be begun instead.
    pub render_pass: vk::RenderPass,
    /// For dynamic rendering: formats of the colour attachments; read during the call. Colours are
    /// linear, and the format encodes them: see REVMAP_PLANES_COLOR.
    pub color_formats: *const vk::Format,
    /// For dynamic rendering: number of the colour attachments.
    pub color_format_count: u32,
    /// For dynamic rendering: format of the depth attachment.
    pub depth_format: vk::Format,
    /// For dynamic rendering: format of the stencil attachment; VK_FORMAT_UNDEFINED if there is
    /// none.
    pub stencil_format: vk::Format,
    /// Not read.
    pub padding: u32,
    /// For REVMAP_PLANES_LIST: a RevmapAttachment for each colour attachment, in order, none twice;
    /// read during the call.
    pub attachments: *const u32,
    /// For REVMAP_PLANES_LIST: number of attachments.
    pub attachment_count: u32,
    /// 1 for a ray through each sample, so that silhouettes are smooth; a pixel costs as many rays,
    /// and the device needs the feature sampleRateShading. 0 for one ray through the pixel's
    /// centre, which all samples share.
    pub sample_rays: u32,
    /// A RevmapDepthCompare.
    pub depth_compare: u32,
    /// 1 to leave the depth attachment as it is, 0 to write depths.
    pub depth_read_only: u32,
    /// 1 or 0. A pass draws one view, and its view mask is 0: begin a pass for each view, and prepare
    /// each view in a slot of its own.
    pub views: u32,
    /// For REVMAP_PLANES_DEPTH and REVMAP_PLANES_DEPTH_PARALLEL: depths move away from the eye by
    /// this times the slope, the larger change of depth from a pixel to the next. 0 for no bias.
    pub slope_bias: f32,
    /// The most that slope_bias moves a depth, units of the depth buffer; above 0 with a slope_bias.
    pub slope_bias_limit: f32,
    /// Not read.
    pub padding_end: u32,
}

/// The target of compute shaders, and of fragments of REVMAP_PLANES_ALL besides their attachments.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RevmapComputeTarget {
    /// sizeof(RevmapComputeTarget).
    pub size: u32,
    /// Number of images: 4 for REVMAP_PLANES_ALL in compute, else 0.
    pub image_count: u32,
    /// A storage buffer of two 32-bit words a pixel, row by row from the top: the depths of all
    /// pixels, as bits of floats; then a second word of each, which is the colour, packed as
    /// R8G8B8A8_SRGB, for REVMAP_PLANES_COLOR, else a count of look-ups. The host clears it before
    /// a frame, depths to 1.0 and colours to its background, or fills in what is already drawn.
    pub words: vk::Buffer,
    /// Storage images of all planes, R32G32B32A32_SFLOAT in the layout GENERAL; read during the
    /// call.
    pub images: *const vk::ImageView,
}

described! {
    RevmapPass {
        0 => [
            size, kind, samples, depth_order, planes, subpass, render_pass, color_formats,
            color_format_count, depth_format, stencil_format, padding,
        ]
        1 => [
            attachments, attachment_count, sample_rays, depth_compare, depth_read_only, views,
            slope_bias, slope_bias_limit, padding_end,
        ]
    }
    RevmapComputeTarget { 0 => [size, image_count, words, images] }
}

impl RevmapPass {
    unsafe fn formats(&self) -> Outcome<PassFormats> {
        if self.views > 1 {
            let message = format!(
                "views: {} in one pass; give 1, and begin a pass for each view",
                self.views
            );
            return Err(Fault::new(RevmapResult::Usage, message));
        }
        let begun = match enums::pass_kind(self.kind)? {
            RevmapPassKind::RenderPass => PassKind::RenderPass {
                // SAFETY: the caller's pass, which lives as long as it promised.
                pass: unsafe { HostPass::new(self.render_pass) },
                subpass: self.subpass,
            },
            RevmapPassKind::Dynamic => {
                let count = self.color_format_count as usize;
                PassKind::Dynamic {
                    color: list(self.color_formats, count, "color formats")?.to_vec(),
                    depth: self.depth_format,
                    stencil: self.stencil_format,
                }
            }
        };
        let planes = match enums::planes(self.planes)? {
            // SAFETY: as above.
            Planes::List(_) => Planes::List(unsafe { self.plane_list() }?),
            planes => planes,
        };
        let depth = enums::depth_order(self.depth_order)?;
        let [normal, reversed] = enums::depth_compare(self.depth_compare)?;
        let depth_test = DepthTest {
            compare: Some(match depth {
                DepthOrder::Normal => normal,
                DepthOrder::Reversed => reversed,
            }),
            write: self.depth_read_only == 0,
        };
        Ok(PassFormats {
            samples: self.samples,
            sample_rays: self.sample_rays != 0,
            depth,
            depth_test,
            slope_bias: SlopeBias::new(self.slope_bias, self.slope_bias_limit)?,
            ..PassFormats::new(begun, planes)
        })
    }

    unsafe fn plane_list(&self) -> Outcome<PlaneList> {
        let count = self.attachment_count as usize;
        let numbers = list(self.attachments, count, "attachments")?;
        let planes: Outcome<Vec<_>> = numbers.iter().map(|&n| enums::attachment(n)).collect();
        Ok(PlaneList::new(&planes?)?)
    }
}

/// A renderer without objects.
///
/// # Safety
/// `search` is null or the caller's structure.
unsafe fn recorder(
    device: *const RevmapDevice,
    output: Output,
    search: *const RevmapSearch,
    frames: u32,
    shading: Option<(*const RevmapShading, vk::DescriptorSetLayout)>,
) -> Outcome<Mutex<Recorder>> {
    let settings = crate::values::search(search)?;
    let device = RevmapDevice::get(device)?;
    let in_pass = matches!(output, Output::Pass(_));
    let slots = frames as usize;
    let renderer = match shading {
        None => Renderer::new(&device, output, &settings, slots),
        Some((shading, set_layout)) => {
            let shading = RevmapShading::get(shading)?;
            let host = HostShading {
                shading,
                set_layout,
            };
            // SAFETY: the shading and its layout are as the caller has promised.
            unsafe { Renderer::with_shading(&device, output, &settings, slots, &host) }
        }
    }?;
    Ok(Mutex::new(Recorder {
        renderer,
        in_pass,
        prepared: (0..frames).map(|_| None).collect(),
        notes: Vec::new(),
    }))
}

/// Makes a renderer without objects that draws fragments in a host's pass. A null search is the
/// default one. frames is the number of slots, 1 to 64: frames in flight times views.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_create(
    device: *const RevmapDevice,
    pass: *const RevmapPass,
    search: *const RevmapSearch,
    frames: u32,
    renderer: *mut *mut RevmapRenderer,
) -> RevmapResult {
    create(renderer, || {
        let output = Output::Pass(read(pass)?.formats()?);
        recorder(device, output, search, frames, None)
    })
}

/// Makes a renderer without objects that traces in compute shaders, into a RevmapComputeTarget.
/// planes is a RevmapPlanes. A null search is the default one. frames is the number of slots, 1 to
/// 64: frames in flight times views.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_create_compute(
    device: *const RevmapDevice,
    planes: u32,
    search: *const RevmapSearch,
    frames: u32,
    renderer: *mut *mut RevmapRenderer,
) -> RevmapResult {
    create(renderer, || {
        let output = Output::Compute(enums::planes(planes)?);
        recorder(device, output, search, frames, None)
    })
}

/// Makes a renderer as revmap_renderer_create() does, with a host's function that shades in place of
/// the library's. The function takes no lights of revmap_renderer_set_lighting(). set_layout is the
/// layout of descriptor set 3, for fragments; null if the function reads none. The layout has every
/// binding that the function reads, and lives as long as the renderer.
///
/// Whenever the renderer records, a set of the layout is bound at number 3 with
/// revmap_renderer_pipeline_layout().
///
/// Fails with REVMAP_RESULT_USAGE for a shading of the other stage, for a pass without colour, and for
/// a function that reads set 3 if the layout is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_create_with_shading(
    device: *const RevmapDevice,
    pass: *const RevmapPass,
    shading: *const RevmapShading,
    set_layout: vk::DescriptorSetLayout,
    search: *const RevmapSearch,
    frames: u32,
    renderer: *mut *mut RevmapRenderer,
) -> RevmapResult {
    create(renderer, || {
        let output = Output::Pass(read(pass)?.formats()?);
        recorder(device, output, search, frames, Some((shading, set_layout)))
    })
}

/// Makes a renderer as revmap_renderer_create_compute() does, with a host's function that shades as in
/// revmap_renderer_create_with_shading(). planes must be REVMAP_PLANES_COLOR; set_layout is for
/// compute.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_create_compute_with_shading(
    device: *const RevmapDevice,
    planes: u32,
    shading: *const RevmapShading,
    set_layout: vk::DescriptorSetLayout,
    search: *const RevmapSearch,
    frames: u32,
    renderer: *mut *mut RevmapRenderer,
) -> RevmapResult {
    create(renderer, || {
        let output = Output::Compute(enums::planes(planes)?);
        recorder(device, output, search, frames, Some((shading, set_layout)))
    })
}

/// Returns the layout of all pipelines of a renderer, with which a host binds its set 3. The layout
/// lives as long as the renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_pipeline_layout(
    renderer: *mut RevmapRenderer,
    layout: *mut vk::PipelineLayout,
) -> RevmapResult {
    put(layout, "layout", || {
        with(renderer, |r| Ok(r.renderer.pipeline_layout()?))
    })
}

/// Sets lights and shadows for all objects.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_set_lighting(
    renderer: *mut RevmapRenderer,
    lighting: *const RevmapLighting,
) -> RevmapResult {
    enter(|| {
        let lighting = read(lighting)?.lighting()?;
        with(renderer, |r| Ok(r.renderer.set_lighting(&lighting)?))
    })
}

/// Sets the target of compute, from the next prepared frame on. The handles are of the renderer's
/// device, large enough for every view's viewport, which begins at 0. The handles live until
/// another target is set and the frames recorded before are done.
///
/// Fails with REVMAP_RESULT_USAGE if the renderer's shaders write to no such target.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_set_compute_target(
    renderer: *mut RevmapRenderer,
    target: *const RevmapComputeTarget,
) -> RevmapResult {
    enter(|| {
        let target = read(target)?;
        let images = list(target.images, target.image_count as usize, "images")?.to_vec();
        let words = target.words;
        with(renderer, |r| {
            let target = ComputeTarget {
                words,
                images,
                depths: true,
            };
            Ok(r.renderer.set_compute_target(target)?)
        })
    })
}

/// With hides not 0, revmap_renderer_prepare() compiles no pipeline: draws that need one that is
/// not compiled are left out, until revmap_prewarm_compile() has made it on another thread.
/// RevmapFrameStatistics counts what is left out. A new renderer compiles what it needs.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_hide_until_compiled(
    renderer: *mut RevmapRenderer,
    hides: u32,
) -> RevmapResult {
    enter_with(renderer, |r| {
        r.renderer.hide_until_compiled(hides != 0);
        Ok(())
    })
}

/// Returns the second word of a pixel of a linear colour, for REVMAP_PLANES_COLOR: the clear value
/// of a RevmapComputeTarget's colours.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_color_word(red: f32, green: f32, blue: f32, alpha: f32) -> u32 {
    ComputeTarget::color_word([red, green, blue, alpha])
}

/// Destroys a renderer; null is none. The frames that it recorded must be done.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_destroy(renderer: *mut RevmapRenderer) -> RevmapResult {
    enter(|| RevmapRenderer::destroy(renderer))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A depth test is that of either depth order.
    #[test]
    fn a_pass_tests_depths_as_it_says() {
        use crate::enums::{RevmapDepthCompare as C, RevmapDepthOrder as D};
        use vk::CompareOp as Op;
        for (compare, order, wanted) in [
            (C::Nearer, D::Normal, Op::LESS),
            (C::NearerOrEqual, D::Reversed, Op::GREATER_OR_EQUAL),
            (C::Equal, D::Normal, Op::EQUAL),
            (C::Farther, D::Reversed, Op::LESS),
            (C::FartherOrEqual, D::Normal, Op::GREATER_OR_EQUAL),
            (C::NotEqual, D::Reversed, Op::NOT_EQUAL),
            (C::Always, D::Normal, Op::ALWAYS),
            (C::Never, D::Normal, Op::NEVER),
        ] {
            let mut pass = crate::structures::sized::<RevmapPass>();
            (pass.depth_compare, pass.depth_order) = (compare as u32, order as u32);
            for read_only in [0, 1] {
                pass.depth_read_only = read_only;
                // SAFETY: it has no pointers.
                let test = unsafe { pass.formats() }.unwrap().depth_test;
                assert_eq!((test.compare, test.write), (Some(wanted), read_only == 0));
            }
        }
    }
}
