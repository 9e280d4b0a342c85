//! Keys whose values change from frame to frame.

use super::output::usage;
use revmap::error::Result;

/// A key whose value changes from frame to frame.
pub struct Vary {
    pub key: String,
    from: Vec<f64>,
    to: Vec<f64>,
    list: bool,
}

impl Vary {
    /// True if the value changes.
    pub fn moves(&self) -> bool {
        self.from != self.to
    }

    pub fn parse(text: &str) -> Result<Self> {
        let wrong = |what: &str| {
            let example = "write KEY=FROM:TO, as in object.0.extend=0:0.1";
            usage("--vary", format!("{text:?} {what}; {example}"))
        };
        let parts = text.split_once('=');
        let (key, range) = parts.ok_or_else(|| wrong("names no values"))?;
        let parts = range.split_once(':');
        let (from, to) = parts.ok_or_else(|| wrong("has no second value"))?;
        let list = from.trim().starts_with('[');
        let numbers = |text: &str| {
            let inner = text.trim().trim_start_matches('[').trim_end_matches(']');
            let number = |n: &str| n.trim().parse().ok().filter(|n: &f64| n.is_finite());
            let parsed: Option<Vec<f64>> = inner.split(',').map(number).collect();
            parsed.ok_or_else(|| wrong("holds what is no number"))
        };
        let (from, to) = (numbers(from)?, numbers(to)?);
        if from.len() != to.len() {
            return Err(wrong("has lists of two lengths"));
        }
        if !list && from.len() != 1 {
            return Err(wrong(
                "has a comma outside of brackets, and numbers have points",
            ));
        }
        Ok(Self {
            key: key.trim().to_owned(),
            from,
            to,
            list,
        })
    }

    /// The assignment at the fraction `part`, 0 to 1.
    pub fn at(&self, part: f64) -> String {
        let pairs = self.from.iter().zip(&self.to);
        let values: Vec<f64> = pairs.map(|(a, b)| a + (b - a) * part).collect();
        // Keys of whole numbers take no 10.0.
        let whole = |x: &f64| x.fract() == 0.0 && x.abs() < 1e15;
        let texts = values.iter().map(|x| match whole(x) {
            true => format!("{x}"),
            false => format!("{x:?}"),
        });
        let bare = texts.collect::<Vec<_>>().join(", ");
        let list = format!("[{bare}]");
        format!("{}={}", self.key, if self.list { list } else { bare })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use revmap::error::ErrorKind;

    #[test]
    fn keys_move_from_value_to_value() {
        let one = Vary::parse("object.0.extend=0:0.1").unwrap();
        assert_eq!(one.at(0.5), "object.0.extend=0.05");
        let three = Vary::parse("camera.eye=[1, 2, -3]:[0,0,0]").unwrap();
        assert_eq!(three.at(0.0), "camera.eye=[1, 2, -3]");
        for bad in [
            "a",
            "a=1",
            "a=1:b",
            "a=[1,2]:3",
            "a=nan:1",
            "a=0,1:0,2",
            "a=0:0,2",
        ] {
            let error = Vary::parse(bad).err().unwrap();
            assert_eq!(error.kind, ErrorKind::Usage, "{bad}");
        }
    }
}
