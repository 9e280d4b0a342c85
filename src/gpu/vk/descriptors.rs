//! The one table of descriptors. Layouts, pools and writes follow from this table, and a test
//! compares it with the shaders.

use crate::error::Result;
use crate::gpu::vk::call::Call;
use crate::shader::generated::MAX_SHADOW_MAPS;
use ash::vk;
use vk::{DescriptorType as Kind, ShaderStageFlags as Stages};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Binding {
    pub kind: Kind,
    pub count: u32,
    pub stages: Stages,
}

const COMPUTE: Stages = Stages::COMPUTE;
const PIXEL: Stages = Stages::from_raw(Stages::FRAGMENT.as_raw() | COMPUTE.as_raw());
/// All stages of the library's shaders.
pub(crate) const EVERY: Stages = Stages::from_raw(Stages::VERTEX.as_raw() | PIXEL.as_raw());

const fn one(kind: Kind, stages: Stages) -> Binding {
    Binding {
        kind,
        count: 1,
        stages,
    }
}

const TEXTURE: Binding = one(Kind::COMBINED_IMAGE_SAMPLER, PIXEL);
const PLANE: Binding = one(Kind::STORAGE_IMAGE, COMPUTE);

/// Set 0: buffers of a frame.
pub(crate) const FRAME_SET: usize = 0;
/// Set 1: textures of an object.
pub(crate) const TEXTURE_SET: usize = 1;
/// Set 2: tiles, and the target of a compute pass.
pub(crate) const TARGET_SET: usize = 2;

pub(crate) const SETS: [&[Binding]; 3] = [
    &[
        one(Kind::UNIFORM_BUFFER, EVERY),         // the frame
        one(Kind::STORAGE_BUFFER, EVERY),         // objects
        one(Kind::STORAGE_BUFFER, EVERY),         // instances
        one(Kind::STORAGE_BUFFER, EVERY),         // hierarchies of copies
        one(Kind::STORAGE_BUFFER, EVERY),         // tables of all solids
        one(Kind::UNIFORM_BUFFER_DYNAMIC, PIXEL), // the only tables
        one(Kind::UNIFORM_BUFFER_DYNAMIC, EVERY), // the only object
        one(Kind::UNIFORM_TEXEL_BUFFER, EVERY),   // vectors of the objects
        one(Kind::UNIFORM_TEXEL_BUFFER, PIXEL),   // of the instances
        one(Kind::UNIFORM_TEXEL_BUFFER, EVERY),   // of the hierarchies
        one(Kind::UNIFORM_TEXEL_BUFFER, EVERY),   // of the tables
        one(Kind::STORAGE_BUFFER, COMPUTE),       // instances before they are placed
    ],
    &[
        TEXTURE, // shape map
        TEXTURE, // colours
        TEXTURE, // slopes
        TEXTURE, // lengths along the outline
        Binding {
            count: MAX_SHADOW_MAPS,
            ..TEXTURE
        }, // shape maps that shadows read
    ],
    &[
        one(Kind::STORAGE_BUFFER, PIXEL),   // words of pixels
        one(Kind::STORAGE_BUFFER, COMPUTE), // open pixels
        PLANE,
        PLANE,
        PLANE,
        PLANE,
        one(Kind::STORAGE_BUFFER, COMPUTE), // bins of tiles
    ],
];

/// The bindings of [`TEXTURE_SET`] under a host's shading, which reads no shadows. Other textures
/// that Vulkan guarantees are the host's.
pub(crate) const HOST_TEXTURES: &[Binding] = SETS[TEXTURE_SET].split_at(4).0;

/// The number of descriptors of some kinds in all sets that one of these stages may read.
pub(crate) fn count(kinds: &[Kind], stages: Stages) -> u32 {
    let counts = |of: &&Binding| kinds.contains(&of.kind) && of.stages.intersects(stages);
    let all = SETS.iter().flat_map(|set| set.iter());
    all.filter(counts).map(|of| of.count).sum()
}

pub(crate) fn layout(raw: &ash::Device, bindings: &[Binding]) -> Result<vk::DescriptorSetLayout> {
    let bindings: Vec<_> = (0u32..)
        .zip(bindings)
        .map(|(number, binding)| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(number)
                .descriptor_type(binding.kind)
                .descriptor_count(binding.count)
                .stage_flags(binding.stages)
        })
        .collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    // SAFETY: a plain creation, which the caller destroys.
    unsafe { raw.create_descriptor_set_layout(&info, None) }.call("vkCreateDescriptorSetLayout")
}

/// Makes a pool of `count` of each of these sets, and the sets, in order.
pub(crate) fn allocate(
    raw: &ash::Device,
    layouts: &[vk::DescriptorSetLayout; 3],
    sets: &[usize],
    count: u32,
) -> Result<(vk::DescriptorPool, Vec<vk::DescriptorSet>)> {
    let bindings = sets.iter().flat_map(|&set| SETS[set]);
    let sizes: Vec<_> = bindings
        .map(|binding| {
            vk::DescriptorPoolSize::default()
                .ty(binding.kind)
                .descriptor_count(binding.count * count)
        })
        .collect();
    let info = vk::DescriptorPoolCreateInfo::default()
        .max_sets(sets.len() as u32 * count)
        .pool_sizes(&sizes);
    // SAFETY: a plain creation, which the caller destroys.
    let pool = unsafe { raw.create_descriptor_pool(&info, None) }.call("vkCreateDescriptorPool")?;
    let wanted: Vec<_> = (0..count)
        .flat_map(|_| sets.iter().map(|&set| layouts[set]))
        .collect();
    let info = vk::DescriptorSetAllocateInfo::default()
        .descriptor_pool(pool)
        .set_layouts(&wanted);
    // SAFETY: the pool was sized for these sets.
    match unsafe { raw.allocate_descriptor_sets(&info) }.call("vkAllocateDescriptorSets") {
        Ok(made) => Ok((pool, made)),
        Err(error) => {
            // SAFETY: nothing was allocated from the pool.
            unsafe { raw.destroy_descriptor_pool(pool, None) };
            Err(error)
        }
    }
}

/// A resource that a binding points to.
#[derive(Clone, Copy)]
pub(crate) enum Resource {
    Buffer(vk::Buffer, u64),
    Texels(vk::BufferView),
    Image(vk::ImageView),
}

/// Points bindings of a set of this number to resources.
///
/// # Safety
/// The call writes to the set. The caller must ensure that the resources live while the set is
/// used, and that no frame that is recorded or in flight reads the set.
pub(crate) unsafe fn write(
    raw: &ash::Device,
    set: vk::DescriptorSet,
    number: usize,
    resources: &[(u32, Resource)],
) {
    for &(binding, resource) in resources {
        let kind = SETS[number][binding as usize].kind;
        let to = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding)
            .descriptor_type(kind);
        let (buffer, image, texels);
        let to = match resource {
            Resource::Buffer(raw, range) => {
                buffer = [vk::DescriptorBufferInfo::default().buffer(raw).range(range)];
                to.buffer_info(&buffer)
            }
            Resource::Texels(view) => {
                texels = [view];
                to.texel_buffer_view(&texels)
            }
            Resource::Image(view) => {
                let layout = vk::ImageLayout::GENERAL;
                let info = vk::DescriptorImageInfo::default().image_view(view);
                image = [info.image_layout(layout)];
                to.image_info(&image)
            }
        };
        // SAFETY: as the caller promised.
        unsafe { raw.update_descriptor_sets(&[to], &[]) };
    }
}

#[cfg(test)]
mod tests {
    use super::{SETS, Stages};
    use crate::shader::{instructions, modules, op, words};
    use std::collections::BTreeMap;

    /// The table of descriptors agrees with every binding that a module reads, and with the stages of
    /// those modules.
    #[test]
    fn descriptors_are_those_of_the_shaders() {
        let mut seen = BTreeMap::new();
        for module in modules() {
            let words = words(&module).unwrap();
            let all: Vec<_> = instructions(&words)
                .map(|(code, one)| (code, one[1..].to_vec()))
                .collect();
            let (_, entry) = all
                .iter()
                .find(|(code, _)| *code == op::ENTRY_POINT)
                .unwrap();
            let stage = match entry[0] {
                0 => Stages::VERTEX,
                4 => Stages::FRAGMENT,
                _ => Stages::COMPUTE,
            };
            let decorated = |id: u32, what: u32| {
                let of = |(code, w): &&(u32, Vec<u32>)| {
                    *code == op::DECORATE && w[0] == id && w[1] == what
                };
                all.iter().find(of).map(|(_, w)| w[2])
            };
            let defined = |id: u32| {
                all.iter()
                    .find(|(code, w)| is_type(*code) && w[0] == id)
                    .unwrap()
            };
            for (_, w) in all.iter().filter(|(code, _)| *code == op::VARIABLE) {
                let (Some(set), Some(binding)) = (
                    decorated(w[1], op::DESCRIPTOR_SET),
                    decorated(w[1], op::BINDING),
                ) else {
                    continue;
                };
                let (code, pointer) = defined(w[0]);
                assert_eq!(*code, op::TYPE_POINTER);
                let mut of = defined(pointer[2]);
                if of.0 == op::TYPE_ARRAY {
                    of = defined(of.1[1]);
                }
                use ash::vk::DescriptorType as T;
                let wanted: &[T] = match (w[2], of.0) {
                    (_, op::TYPE_IMAGE) if is_view(of) => &[T::UNIFORM_TEXEL_BUFFER],
                    (_, op::TYPE_SAMPLED_IMAGE) => &[T::COMBINED_IMAGE_SAMPLER],
                    (_, op::TYPE_IMAGE) => &[T::STORAGE_IMAGE],
                    (2, _) => &[T::UNIFORM_BUFFER, T::UNIFORM_BUFFER_DYNAMIC],
                    _ => &[T::STORAGE_BUFFER],
                };
                let known = SETS[set as usize][binding as usize];
                assert!(
                    wanted.contains(&known.kind),
                    "{}: {set}, {binding}",
                    module.name()
                );
                *seen.entry((set, binding)).or_insert(Stages::empty()) |= stage;
            }
        }
        let all: usize = SETS.iter().map(|set| set.len()).sum();
        assert_eq!(seen.len(), all, "bindings that no shader reads");
        for ((set, binding), stages) in seen {
            let known = SETS[set as usize][binding as usize].stages;
            assert_eq!(known, stages, "{set}, {binding}");
        }
    }

    /// True if an image is a view of a buffer.
    fn is_view((_, image): &(u32, Vec<u32>)) -> bool {
        const BUFFER: u32 = 5;
        image[2] == BUFFER
    }

    fn is_type(code: u32) -> bool {
        (op::TYPE_VOID..=op::TYPE_LAST).contains(&code)
    }
}
