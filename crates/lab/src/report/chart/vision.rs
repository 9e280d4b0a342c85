//! Colours as eyes of every kind see them, to test what charts demand of their readers: dichromatic
//! vision after Machado, Oliveira and Fernandes (2009, severity 1), distances in CIE Lab of 1976,
//! contrast as WCAG 2 counts it.

use revmap::frame::linear_from_srgb;

/// Kinds of colour vision, as a matrix on linear RGB.
#[derive(Clone, Copy)]
pub struct Eyes {
    pub name: &'static str,
    matrix: [[f64; 3]; 3],
}

/// Normal, red-blind, green-blind and blue-blind.
pub const EYES: [Eyes; 4] = [
    Eyes {
        name: "normal",
        matrix: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    },
    Eyes {
        name: "protanopia",
        matrix: [
            [0.152_286, 1.052_583, -0.204_868],
            [0.114_503, 0.786_281, 0.099_216],
            [-0.003_882, -0.048_116, 1.051_998],
        ],
    },
    Eyes {
        name: "deuteranopia",
        matrix: [
            [0.367_322, 0.860_646, -0.227_968],
            [0.280_085, 0.672_501, 0.047_413],
            [-0.011_820, 0.042_940, 0.968_881],
        ],
    },
    Eyes {
        name: "tritanopia",
        matrix: [
            [1.255_528, -0.076_749, -0.178_779],
            [-0.078_411, 0.930_809, 0.147_602],
            [0.004_733, 0.691_367, 0.303_900],
        ],
    },
];

impl Eyes {
    /// A linear colour as these eyes see it.
    pub fn see(self, c: [f64; 3]) -> [f64; 3] {
        self.matrix
            .map(|row| (row[0] * c[0] + row[1] * c[1] + row[2] * c[2]).clamp(0.0, 1.0))
    }
}

/// `#rrggbb` as linear RGB.
pub fn rgb(color: &str) -> [f64; 3] {
    [1, 3, 5].map(|at| {
        let part = f64::from(u8::from_str_radix(&color[at..at + 2], 16).unwrap_or(0)) / 255.0;
        linear_from_srgb(part)
    })
}

/// Linear RGB as CIE Lab under D65.
pub fn lab([r, g, b]: [f64; 3]) -> [f64; 3] {
    let part = |t: f64| {
        if t > 216.0 / 24389.0 {
            t.cbrt()
        } else {
            (24389.0 / 27.0 * t + 16.0) / 116.0
        }
    };
    let x = part((0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b) / 0.950_47);
    let y = part(0.212_672_9 * r + 0.715_152_2 * g + 0.072_175 * b);
    let z = part((0.019_333_9 * r + 0.119_192 * g + 0.950_304_1 * b) / 1.088_83);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// How far two colours are apart to these eyes.
pub fn distance(a: &str, b: &str, eyes: Eyes) -> f64 {
    let (a, b) = (lab(eyes.see(rgb(a))), lab(eyes.see(rgb(b))));
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Contrast, 1 to 21.
pub fn contrast(a: &str, b: &str) -> f64 {
    let light = |c: &str| {
        let [r, g, b] = rgb(c);
        0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
    };
    let (a, b) = (light(a), light(b));
    a.max(b) / a.min(b)
}
