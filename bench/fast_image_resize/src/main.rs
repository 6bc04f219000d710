//! fast_image_resize, as bench/README.md asks a program to answer.

use fast_image_resize::images::{Image, ImageRef};
use fast_image_resize::{
    create_srgb_mapper, FilterType, PixelComponentMapper, PixelType, ResizeAlg, ResizeOptions, Resizer,
};
use std::error::Error;
use std::io::{BufRead, Write};
use std::time::Instant;

type Outcome<T> = Result<T, Box<dyn Error>>;

const HELLO: &str = "fast_image_resize 6.1.0\t2\tconvolution, its Resizer, buffers and threads made beforehand; \
                     g: its sRGB mapper to 16 bits, alpha multiplied and divided there, and back";

/// The operation that was last asked for, with its pictures.
struct Work {
    size: (u32, u32),
    levels: Vec<(u32, u32)>,
    pixel: PixelType,
    options: ResizeOptions,
    linear: Option<Linear>,
    pool: rayon::ThreadPool,
    resizer: Resizer,
    sources: Vec<Vec<u8>>,
    /// One per copy and level.
    targets: Vec<Vec<Vec<u8>>>,
}

/// What linear light needs between the steps.
struct Linear {
    mapper: PixelComponentMapper,
    large: Image<'static>,
    small: Image<'static>,
}

impl Work {
    /// `words`: width height new_width new_height samples kernel chain light threads copies path
    fn new(words: &[&str]) -> Outcome<Work> {
        let size = (words[0].parse()?, words[1].parse()?);
        let mut levels: Vec<(u32, u32)> = vec![(words[2].parse()?, words[3].parse()?)];
        while words[6] == "chain" && levels[levels.len() - 1] != (1, 1) {
            let (w, h) = levels[levels.len() - 1];
            levels.push(((w / 2).max(1), (h / 2).max(1)));
        }
        let pixel = if words[4] == "f32" { PixelType::F32 } else { PixelType::U8x4 };
        let filter = if words[5] == "box" { FilterType::Box } else { FilterType::Lanczos3 };
        let linear = (words[7] == "linear").then(|| Linear {
            mapper: create_srgb_mapper(),
            large: Image::new(size.0, size.1, PixelType::U16x4),
            small: Image::new(levels[0].0, levels[0].1, PixelType::U16x4),
        });
        let copies: usize = words[9].parse()?;
        let source = std::fs::read(words[10])?;
        let target = |&(w, h): &(u32, u32)| vec![1u8; w as usize * h as usize * pixel.size()];
        Ok(Work {
            size,
            pixel,
            options: ResizeOptions::new().resize_alg(ResizeAlg::Convolution(filter)).use_alpha(linear.is_some()),
            linear,
            pool: rayon::ThreadPoolBuilder::new().num_threads(words[8].parse()?).build()?,
            resizer: Resizer::new(),
            sources: vec![source; copies],
            targets: (0..copies).map(|_| levels.iter().map(target).collect()).collect(),
            levels,
        })
    }

    /// Seconds that it took.
    fn run(&mut self, k: usize) -> Outcome<f64> {
        let Work { size, levels, pixel, options, linear, pool, resizer, sources, targets } = self;
        let start = Instant::now();
        pool.install(|| -> Result<(), String> {
            let mut from: &[u8] = &sources[k];
            let mut size = *size;
            for (level, target) in levels.iter().zip(targets[k].iter_mut()) {
                let source = ImageRef::new(size.0, size.1, from, *pixel).map_err(|e| e.to_string())?;
                let mut to = Image::from_slice_u8(level.0, level.1, target, *pixel).map_err(|e| e.to_string())?;
                if let Some(Linear { mapper, large, small }) = linear {
                    mapper.forward_map(&source, large).map_err(|e| e.to_string())?;
                    resizer.resize(large, small, &*options).map_err(|e| e.to_string())?;
                    mapper.backward_map(small, &mut to).map_err(|e| e.to_string())?;
                } else {
                    resizer.resize(&source, &mut to, &*options).map_err(|e| e.to_string())?;
                }
                from = target;
                size = *level;
            }
            Ok(())
        })?;
        Ok(start.elapsed().as_secs_f64())
    }
}

fn answer(line: &str, work: &mut Option<Work>) -> Outcome<String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match (words[0], work) {
        ("hello", _) => Ok(HELLO.to_string()),
        ("prepare", work) => {
            *work = Some(Work::new(&words[1..])?);
            Ok("ready".to_string())
        }
        ("run", Some(work)) => Ok(work.run(words[1].parse()?)?.to_string()),
        ("save", Some(work)) => {
            std::fs::write(words[2], work.targets[words[1].parse::<usize>()?].concat())?;
            Ok("saved".to_string())
        }
        _ => Err(format!("cannot do: {line}").into()),
    }
}

fn main() -> Outcome<()> {
    let mut work = None;
    for line in std::io::stdin().lock().lines() {
        let text = answer(&line?, &mut work)?;
        println!("{text}");
        std::io::stdout().flush()?;
    }
    Ok(())
}
