//! Shape maps of every source, baked and stored.

use glam::DVec2;
use proptest::prelude::*;
use revmap::maps::{BakeOptions, MapFormat, MapSource, ShapeMap};
use revmap::profile::{Profile, Raster};
use revmap_files::{BINARY, COVERAGE, trace};

const SOURCES: [MapSource; 3] = [BINARY, COVERAGE, MapSource::EXACT];

fn cylinder() -> Profile {
    Profile::polygon(&[[0.0, 0.25], [0.25, 0.25], [0.25, 0.75], [0.0, 0.75]], 0.5).unwrap()
}

/// A map of at least the reach.
fn baked(profile: &Profile, source: MapSource, rows: u32, reach: f64) -> revmap::Result<ShapeMap> {
    let options = BakeOptions {
        source,
        rows,
        reach,
    };
    ShapeMap::bake(profile, &options)
}

#[test]
fn the_borders_of_an_image_are_boundaries_and_the_axis_is_none() {
    let full = trace(Raster {
        columns: 8,
        rows: 16,
        coverage: vec![1.0; 128],
    });
    let full = full.unwrap();
    for source in SOURCES {
        let map = baked(&full, source, 16, 0.7).unwrap();
        assert_eq!(map.columns, 12);
        let shift = if source == BINARY { 0.0 } else { -0.5 };
        for (k, &d) in map.distance[12 * 8..12 * 9].iter().enumerate() {
            let wanted = k as f64 - 7.0 + shift;
            let found = f64::from(d) * 16.0;
            assert!((found - wanted).abs() < 1e-5, "{source:?} {k}: {found}");
        }
    }
}

#[test]
fn wider_maps_agree_with_narrow_ones() {
    for source in SOURCES {
        let [narrow, wide] = [0.0, 0.9].map(|reach| baked(&cylinder(), source, 32, reach).unwrap());
        assert_eq!((wide.columns, wide.radius), (29, 0.5));
        for row in 0..32 {
            let (a, b) = (
                &narrow.distance[row * 16..][..16],
                &wide.distance[row * 29..][..16],
            );
            assert_eq!(a, b, "{source:?}");
        }
    }
}

#[test]
fn faults_are_named() {
    let cylinder = cylinder();
    let thin = Profile::polygon(&[[0.3, 0.5], [0.301, 0.5], [0.3, 0.501]], 0.5).unwrap();
    for (profile, source, rows, reach, word) in [
        (&cylinder, MapSource::EXACT, 1, 0.0, "map_rows"),
        (&cylinder, MapSource::EXACT, 1 << 20, 0.0, "map_rows"),
        (&cylinder, MapSource::EXACT, 64, f64::NAN, "finite"),
        (&cylinder, MapSource::EXACT, 64, 1e9, "columns"),
        (&thin, BINARY, 16, 0.0, "no texel"),
    ] {
        let text = baked(profile, source, rows, reach).unwrap_err().to_string();
        assert!(text.contains(word), "{text}");
    }
    assert!(baked(&thin, MapSource::EXACT, 16, 0.0).is_ok());
}

#[test]
fn the_same_on_any_number_of_threads() {
    for source in SOURCES {
        let bake = || baked(&cylinder(), source, 200, 0.0).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        assert_eq!(pool.unwrap().install(bake), bake());
    }
}

fn balls() -> Vec<ShapeMap> {
    let points: Vec<[f64; 2]> = (0..=64)
        .map(|i| f64::from(i) * std::f64::consts::PI / 64.0)
        .map(|a| [0.37 * a.sin(), 0.5 - 0.37 * a.cos()])
        .collect();
    let ball = Profile::polygon(&points, 0.5).unwrap();
    SOURCES.map(|s| baked(&ball, s, 100, 0.0).unwrap()).to_vec()
}

#[test]
fn a_stored_distance_never_exceeds_the_true_one() {
    for map in balls() {
        let half = map.encode(MapFormat::R16).unwrap();
        let single = map.encode(MapFormat::R32).unwrap();
        let byte = map.encode(MapFormat::Rgba8).unwrap();
        assert_eq!(half.bytes.len(), map.distance.len() * 2);
        let [half, single, bytes] = [half, single, byte.clone()].map(|e| e.distances());
        for (k, &d) in map.distance.iter().enumerate() {
            let (h, s, b) = (half[k], single[k], bytes[k]);
            assert!(h <= d && h > d - 1e-3, "half {h} for {d}");
            assert_eq!(s, d);
            assert!(
                b <= d.max(0.0) && b > d - byte.scale / 254.0,
                "byte {b} for {d}"
            );
            assert_eq!(byte.bytes[4 * k + 3] == 255, d <= 0.0);
        }
        assert!(
            byte.bytes.chunks(4).any(|t| t[2] >= 254),
            "the scale is used to its end"
        );
    }
}

fn star() -> impl Strategy<Value = Profile> {
    prop::collection::vec(0.08f64..0.34, 3..12).prop_map(|radii| {
        let n = radii.len() as f64;
        let points: Vec<[f64; 2]> = radii
            .iter()
            .zip(0..)
            .map(|(r, k)| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / n) * *r)
            .map(|p| [0.35 + p.x, 0.5 + p.y])
            .collect();
        Profile::polygon(&points, 0.7).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    // Exact maps: each texel holds at most the outline's own distance, and less only by the
    // rounding to 32 bits.
    #[test]
    fn exact_maps_hold_the_outlines_distances(profile in star()) {
        let map = baked(&profile, MapSource::EXACT, 40, 0.0).unwrap();
        for (k, &d) in map.distance.iter().enumerate() {
            let p = DVec2::new(((k % 28) as f64 + 0.5) / 40.0, 1.0 - ((k / 28) as f64 + 0.5) / 40.0);
            let exact = profile.outline.signed_distance(p);
            prop_assert!(f64::from(d) <= exact + 1e-12 && f64::from(d) > exact - 1e-7);
            prop_assert_eq!(map.form[k], exact <= 0.0);
        }
    }

    // Bilinear values between texels are within h / sqrt(2) of the truth, and never exceed it by
    // more beyond the map.
    #[test]
    fn reconstruction_is_bounded(profile in star(), r in -1.5f64..1.5, z in -1.0f64..2.0) {
        let map = baked(&profile, MapSource::EXACT, 40, 0.0).unwrap();
        let exact = profile.outline.signed_distance(DVec2::new(r.abs(), z));
        let read = map.distance_at(r, z);
        let slack = map.texel() * std::f64::consts::FRAC_1_SQRT_2 + 1e-6;
        prop_assert!(read <= exact + slack, "{} for {}", read, exact);
        if r.abs() <= 0.7 && (0.0..=1.0).contains(&z) {
            prop_assert!(read >= exact - slack, "{} for {}", read, exact);
        }
    }
}
