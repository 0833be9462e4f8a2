//! The ways of an agent of `minimal-cognition` under circles and diamonds, its scores, and how far left and right differ:
//! `cargo run --release -p farsa-experiments --example minimal_cognition -- GENOTYPE.gen OUT.svg`.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use farsa_experiments::minimal_cognition::{AgentEpisode, Config, MinimalCognition, Object, Wiring};
use farsa_lab::advanced::{Genotype, read_genotypes};
use farsa_lab::{EpisodeId, Experiment as _};

/// The part of the line that is drawn, to both sides of the object.
const SIDE: f64 = 100.0;

/// The same trials as `farsa test --trials N --seed 1`: mean scores under circles and under diamonds.
fn scores(episode: &mut AgentEpisode, trials: u32) -> [f64; 2] {
    let kinds = episode.config().trials;
    let mut sums = [0.0; 2];
    for trial in 0..trials {
        episode.arrange(EpisodeId {
            seed: 1 | 1 << 63,
            generation: trial / kinds,
            individual: 0,
            trial: trial % kinds,
        });
        while !episode.ended() {
            episode.step();
        }
        sums[usize::from(episode.object().name() == "diamond")] += episode.score();
    }
    sums.map(|sum| 2.0 * sum / f64::from(trials))
}

/// The agent's horizontal distance from the object at every height of it.
fn way(episode: &mut AgentEpisode, object: Object, offset: f64) -> Vec<[f64; 2]> {
    episode.place(object, offset);
    let mut way = vec![[-offset, episode.height()]];
    while !episode.ended() {
        episode.step();
        let [object, agent] = episode.places();
        way.push([agent - object, episode.height()]);
    }
    way
}

/// The largest difference between the way of a trial and that from the other side, for 100 starts under each object, rising.
fn left_from_right(episode: &mut AgentEpisode) -> Vec<f64> {
    let Config { diameter, side, offset, .. } = *episode.config();
    let mut apart = Vec::new();
    for object in [Object::circle(diameter), Object::diamond(side)] {
        for i in 0..100 {
            let start = offset * (f64::from(i) + 0.5) / 100.0;
            let [right, left] = [start, -start].map(|start| way(episode, object, start));
            apart.push(right.iter().zip(&left).map(|([a, _], [b, _])| (a + b).abs()).fold(0.0, f64::max));
        }
    }
    apart.sort_by(f64::total_cmp);
    apart
}

/// A panel of ways, its middle at `x`.
fn panel(svg: &mut String, episode: &mut AgentEpisode, object: Object, color: &str, x: f64) -> std::fmt::Result {
    let Config { start_height, end_height, offset, clip, .. } = *episode.config();
    let y = |height: f64| 40.0 + start_height - height;
    writeln!(svg, r#"<text x="{x}" y="24" text-anchor="middle" font-size="13">{}</text>"#, object.name())?;
    for (at, stroke) in [(0.0, "#999"), (-clip, "#ddd"), (clip, "#ddd")] {
        let (x, top, bottom) = (x + at, y(start_height), y(end_height));
        writeln!(svg, r#"<line x1="{x}" x2="{x}" y1="{top}" y2="{bottom}" stroke="{stroke}"/>"#)?;
    }
    for i in 0..24 {
        let places = way(episode, object, offset * (2.0 * f64::from(i) / 23.0 - 1.0));
        let points = places.iter().step_by(8).chain(places.last());
        let points: Vec<String> =
            points.map(|[at, height]| format!("{:.1},{:.1}", x + at.clamp(-SIDE, SIDE), y(*height))).collect();
        writeln!(
            svg,
            r#"<polyline points="{}" fill="none" stroke="{color}" stroke-opacity="0.6"/>"#,
            points.join(" ")
        )?;
    }
    for (at, text) in [(-clip, format!("-{clip}")), (0.0, "0".into()), (clip, clip.to_string())] {
        let (x, y) = (x + at, y(end_height) + 15.0);
        writeln!(svg, r##"<text x="{x}" y="{y}" text-anchor="middle" font-size="10" fill="#555">{text}</text>"##)?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [genotype, out] = &arguments[..] else { return Err("usage: minimal_cognition GENOTYPE.gen OUT.svg".into()) };
    let config = Config::default();
    let wiring = Wiring::new(&config)?;
    let bits = MinimalCognition.gene_bits();
    let genes = read_genotypes(Path::new(genotype), wiring.genes(), bits)?.pop().ok_or("no genotype")?;
    let parameters = Genotype::new(wiring.parameters(), bits).decode(&genes);
    let parameters = parameters.and_then(|parameters| wiring.expand(&parameters)).ok_or("other genes")?;
    let mut episode = AgentEpisode::new(config, parameters)?;
    let [circles, diamonds] = scores(&mut episode, 10_000);
    println!("circles {circles:.4}, diamonds {diamonds:.4}, all {:.4}", 0.5 * (circles + diamonds));
    let apart = left_from_right(&mut episode);
    let (mirrored, most) = (apart.partition_point(|apart| *apart < 0.01), apart.last().copied().unwrap_or_default());
    println!("left and right: {mirrored} of {} pairs of ways within 0.01, the others within {most:.3}", apart.len());

    let mut svg = String::from(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 480 330" font-family="sans-serif" fill="black">"#,
    );
    svg.push_str("\n<rect width=\"480\" height=\"330\" fill=\"white\"/>\n");
    panel(&mut svg, &mut episode, Object::circle(config.diameter), "#009e73", 125.0)?;
    panel(&mut svg, &mut episode, Object::diamond(config.side), "#d55e00", 355.0)?;
    svg.push_str("</svg>\n");
    std::fs::write(out, svg)?;
    Ok(())
}
