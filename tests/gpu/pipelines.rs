//! Pipelines apart from frames: compiled while other threads add caches, and after their renderer.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{Stage, borrow, borrow_through, lent, open, opened};
use crate::common::prelude::*;
use crate::embedding::{options, three};

/// Data is added while another thread compiles, without a message of the validation layers.
#[test]
fn caches_are_added_while_pipelines_are_compiled() {
    let host = open();
    let output = || Output::Pass(host::color_pass());
    let device = borrow(&host);
    let data = {
        let mut first =
            host::renderer_of(&device, output(), &SearchSettings::default(), 1, &three());
        first.prewarm().unwrap().compile().unwrap();
        device.pipeline_cache_data().unwrap()
    };
    let device = borrow(&host);
    let mut renderer = host::renderer_of(&device, output(), &SearchSettings::exact(), 1, &three());
    let prewarm = renderer.prewarm().unwrap();
    assert!(prewarm.len() > 4, "{}", prewarm.len());
    std::thread::scope(|scope| {
        let compiled = scope.spawn(|| prewarm.compile());
        while !compiled.is_finished() {
            device.add_pipeline_cache(&data).unwrap();
        }
        compiled.join().unwrap().unwrap();
    });
    device.add_pipeline_cache(&data).unwrap();
}

/// Bytes that the library did not write do not reach the driver, and a host's cache is the host's.
#[test]
fn other_bytes_are_no_cache() {
    let (host, device) = opened();
    let data = device.pipeline_cache_data().unwrap();
    device.add_pipeline_cache(&data).unwrap();
    let mut changed = data.clone();
    *changed.last_mut().unwrap() ^= 1;
    for bytes in [&[], &data[16..], &data[..data.len() - 1], &changed] {
        let error = device.add_pipeline_cache(bytes).unwrap_err();
        assert_eq!(error.kind, ErrorKind::Usage, "{error}");
    }
    let empty = vk::PipelineCacheCreateInfo::default();
    // SAFETY: a plain creation; the device that borrows the cache is dropped before it.
    unsafe {
        let cache = host.device.create_pipeline_cache(&empty, None).unwrap();
        let with = lent(&host).with(|h| h.pipeline_cache = Some(cache));
        let device = Device::borrow(&with).unwrap();
        let error = device.add_pipeline_cache(&data).unwrap_err();
        assert_eq!(error.key.as_deref(), Some("pipeline_cache"), "{error}");
        drop(device);
        host.device.destroy_pipeline_cache(cache, None);
    }
}

/// A prewarm keeps what it compiles with, and its pipelines end with it.
#[test]
fn a_prewarm_outlives_its_renderer() {
    let (layer, host) = (Layer::take(), open());
    let raw = layer.device(&host.instance, &host.device);
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let options = options().with(|o| o.dynamic = false);
    let stage = Stage::new(&host, options).unwrap();
    let mut before = None;
    for _ in 0..2 {
        let mut renderer = host::renderer(&device, &stage, &SearchSettings::exact(), 1);
        host::add(&mut renderer, &three());
        let prewarm = renderer.prewarm().unwrap();
        drop(renderer);
        let (alive, compiled) = (layer.alive(), device.pipelines_compiled());
        prewarm.compile().unwrap();
        let made = device.pipelines_compiled() - compiled;
        assert_eq!(made, prewarm.len() as u64);
        assert_eq!(layer.alive(), alive + made as i64);
        drop(prewarm);
        // Every pipeline is destroyed, and so is all else that the renderer and the prewarm held.
        assert_eq!(*before.get_or_insert(layer.alive()), layer.alive());
        assert!(layer.alive() <= alive);
    }
    drop(device);
    assert_eq!(layer.alive(), 0);
}
