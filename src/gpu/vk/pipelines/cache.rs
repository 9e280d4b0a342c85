//! The pipeline cache as bytes: the driver's data behind a mark and a hash of the library's.
//!
//! Vulkan lets a driver trust data that it wrote, so no other bytes may reach it.

use super::Pipelines;
use crate::error::{Result, usage};
use crate::gpu::vk::call::Call;
use ash::vk;
use std::sync::PoisonError;

/// The first bytes. The hash of the driver's data follows, then the data.
const MARK: [u8; 8] = *b"revmapPC";

/// The header of `VkPipelineCacheHeaderVersionOne`: four numbers, and the identity of the driver.
const HEADER: usize = 16 + vk::UUID_SIZE;

impl Pipelines {
    pub fn cache_bytes(&self) -> Result<Vec<u8>> {
        let cache = self.cache.read().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the cache is live.
        let data = unsafe { self.raw.get_pipeline_cache_data(*cache) };
        let data = data.call("vkGetPipelineCacheData")?;
        Ok([&MARK[..], &hash(&data).to_le_bytes(), &data].concat())
    }

    /// Adds bytes of another process to the cache, if they are of the same driver and device.
    pub fn add_cache_bytes(
        &self,
        bytes: &[u8],
        properties: &vk::PhysicalDeviceProperties,
    ) -> Result<()> {
        if !self.owns_cache {
            let message =
                "is the host's own; create it with the driver's data, and add none to the device";
            return usage("pipeline_cache", message);
        }
        let Some(data) = written(bytes) else {
            let message = "the data is damaged, or no pipeline_cache_data; compile pipelines anew";
            return usage("data", message);
        };
        if !is_of(data, properties) {
            return Ok(());
        }
        let with = vk::PipelineCacheCreateInfo::default().initial_data(data);
        let cache = self.cache.write().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the data is what this driver returned, by its hash and header. Nothing else uses
        // either cache during the merge.
        unsafe {
            let other = self.raw.create_pipeline_cache(&with, None);
            let other = other.call("vkCreatePipelineCache")?;
            let merged = self.raw.merge_pipeline_caches(*cache, &[other]);
            self.raw.destroy_pipeline_cache(other, None);
            merged.call("vkMergePipelineCaches")
        }
    }
}

/// The driver's data in bytes of [`Pipelines::cache_bytes`]; none in others.
fn written(bytes: &[u8]) -> Option<&[u8]> {
    let (mark, rest) = bytes.split_first_chunk::<8>()?;
    let (sum, data) = rest.split_first_chunk::<8>()?;
    (*mark == MARK && u64::from_le_bytes(*sum) == hash(data)).then_some(data)
}

/// True if a driver's data is of this driver and device.
fn is_of(data: &[u8], properties: &vk::PhysicalDeviceProperties) -> bool {
    let Some((header, _)) = data.split_first_chunk::<HEADER>() else {
        return false;
    };
    let (numbers, identity) = header.split_at(16);
    let numbers = numbers
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let version = vk::PipelineCacheHeaderVersion::ONE.as_raw() as u32;
    let wanted = [version, properties.vendor_id, properties.device_id];
    numbers
        .clone()
        .next()
        .is_some_and(|size| (HEADER..=data.len()).contains(&(size as usize)))
        && numbers.skip(1).eq(wanted)
        && identity == properties.pipeline_cache_uuid
}

/// FNV-1a of 64 bits.
fn hash(data: &[u8]) -> u64 {
    let add = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    data.iter().fold(0xcbf2_9ce4_8422_2325, add)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sealed(data: &[u8]) -> Vec<u8> {
        [&MARK[..], &hash(data).to_le_bytes(), data].concat()
    }

    /// Any change of any byte, and any other length, is found.
    #[test]
    fn only_written_bytes_are_taken() {
        let data: Vec<u8> = (0..200).collect();
        let whole = sealed(&data);
        assert_eq!(written(&whole), Some(&data[..]));
        for at in 0..whole.len() {
            assert_eq!(written(&whole[..at]), None, "{at}");
            let mut changed = whole.clone();
            changed[at] ^= 1;
            assert_eq!(written(&changed), None, "{at}");
        }
        assert_eq!(written(&[&whole[..], &[0]].concat()), None);
        assert_eq!(written(&data), None);
    }

    /// Data of another version, vendor, device or driver, and of no header, is of another device.
    #[test]
    fn data_of_other_devices_is_found() {
        let properties = vk::PhysicalDeviceProperties {
            vendor_id: 7,
            device_id: 9,
            pipeline_cache_uuid: [3; vk::UUID_SIZE],
            ..Default::default()
        };
        let mut data: Vec<u8> = [32u32, 1, 7, 9]
            .iter()
            .flat_map(|n| n.to_le_bytes())
            .collect();
        data.extend([3; vk::UUID_SIZE]);
        data.extend([1, 2, 3]);
        assert!(is_of(&data, &properties));
        for at in (0..HEADER).filter(|at| !(1..4).contains(at)) {
            let mut changed = data.clone();
            changed[at] ^= 64;
            assert!(!is_of(&changed, &properties), "{at}");
            assert!(!is_of(&data[..at], &properties), "{at}");
        }
        assert!(!is_of(&[], &properties));
    }
}
