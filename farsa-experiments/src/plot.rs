//! `fitness.svg`: best, mean and worst fitness over the generations.

use plotters::prelude::*;

use crate::log::Row;

const SIZE: (u32, u32) = (900, 540);

/// Draws the log; text in it is text, so that no font is needed.
///
/// # Errors
/// The backend's words, should it refuse.
pub(crate) fn draw(title: &str, rows: &[Row]) -> Result<String, String> {
    let mut svg = String::new();
    picture(&mut svg, title, rows).map_err(|error| error.to_string())?;
    Ok(svg)
}

fn picture(svg: &mut String, title: &str, rows: &[Row]) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let finite = || rows.iter().flatten().copied().filter(|x| x.is_finite());
    let (mut low, mut high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        (low, high) = (0.0, 1.0);
    }
    // A flat curve needs an axis too.
    let margin = (0.05 * (high - low)).max(1e-9 * high.abs()).max(f64::MIN_POSITIVE.sqrt());
    let last = rows.len().saturating_sub(1).max(1);
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 20))
        .margin(15)
        .x_label_area_size(45)
        .y_label_area_size(75)
        .build_cartesian_2d(0..last, low - margin..high + margin)?;
    chart
        .configure_mesh()
        .x_desc("generation")
        .y_desc("fitness")
        .light_line_style(TRANSPARENT)
        .label_style(("sans-serif", 14))
        .draw()?;
    let colors = [RGBColor(27, 94, 32), RGBColor(21, 101, 192), RGBColor(158, 158, 158)];
    // The best comes last, on top of the others.
    for (curve, (name, color)) in ["best", "mean", "worst"].into_iter().zip(colors).enumerate().rev() {
        let points = rows.iter().enumerate().map(|(generation, row)| (generation, row[curve]));
        // A generation in which all failed leaves a gap in what would be a line to minus infinity.
        let points = points.filter(|(_, fitness)| fitness.is_finite());
        chart
            .draw_series(LineSeries::new(points, color.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], color.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 14))
        .draw()?;
    area.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_log_can_be_drawn() {
        let failed = [f64::NEG_INFINITY; 3];
        for rows in [
            vec![],
            vec![[1.0, 0.5, 0.0]],
            vec![[0.0; 3]; 3],
            vec![[1e9; 3]; 3],
            vec![failed, failed],
            vec![[3.0, 2.0, 1.0], failed, [4.0, 3.0, 2.0]],
        ] {
            let svg = draw("a title", &rows).unwrap();
            for label in ["a title", "generation", "fitness", "best", "mean", "worst", "</svg>"] {
                assert!(svg.contains(label), "{rows:?}: no {label}");
            }
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{rows:?}");
        }
    }
}
