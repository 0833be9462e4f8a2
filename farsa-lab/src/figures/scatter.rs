//! Points in two dimensions as SVG, darker where a third value is larger: the archive or the front of a run.

use plotters::prelude::*;

use crate::figures::plot::{FONT, GRID_COLOR, INK_COLOR, LABELS, Limits, MARGIN, SIZE, label};

/// More points than these are not told apart; every k-th is drawn then.
const MOST_POINTS: usize = 5000;
/// Height of the title and of a line below it.
const HEAD: u32 = 66;
/// The colours of the least and of the largest value, which differ in lightness too.
const PALE: [f64; 3] = [176.0, 216.0, 240.0];
const DARK: [f64; 3] = [0.0, 38.0, 84.0];

/// Points, and what is said of them.
#[derive(Debug, Default)]
pub(crate) struct Scatter<'a> {
    pub(crate) title: &'a str,
    /// What lies to the right, and what upwards.
    pub(crate) axes: [&'a str; 2],
    /// Ranges that are drawn whole, empty or not, where there are such.
    pub(crate) ranges: [Option<[f64; 2]>; 2],
    /// What the colour says.
    pub(crate) shade: &'a str,
    /// The place of each point, and what its colour says.
    pub(crate) points: &'a [([f64; 2], f64)],
}

impl Scatter<'_> {
    /// The picture; text in it is text, so that no font is needed.
    ///
    /// # Errors
    /// The backend's words, should it refuse.
    pub(crate) fn draw(&self) -> Result<String, String> {
        let mut svg = String::new();
        self.picture(&mut svg).map_err(|error| error.to_string())?;
        Ok(svg)
    }

    fn picture<'s>(&self, svg: &'s mut String) -> Result<(), Box<dyn std::error::Error + 's>> {
        let all = SVGBackend::with_string(svg, (SIZE.0, SIZE.0 + HEAD)).into_drawing_area();
        all.fill(&WHITE)?;
        let (head, body) = all.split_vertically(HEAD);
        let shade = Limits::of(self.points.iter().map(|(_, value)| *value));
        let ink = |size| ("sans-serif", size).into_font().color(&INK_COLOR);
        head.draw(&Text::new(self.title.to_owned(), (MARGIN, 12), ink(20)))?;
        let finite = || self.points.iter().map(|(_, value)| *value).filter(|x| x.is_finite());
        let ends = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        if ends[0] <= ends[1] {
            let [low, high] = ends.map(label);
            let text = format!("{}: from {low} (pale) to {high} (dark)", self.shade);
            head.draw(&Text::new(text, (MARGIN, 40), ink(FONT.1)))?;
        }
        let [across, up] = [0, 1].map(|axis| {
            let values = self.points.iter().map(|(place, _)| place[axis]);
            Limits::of(values.chain(self.ranges[axis].into_iter().flatten()))
        });
        let mut chart = ChartBuilder::on(&body)
            .margin_left(8)
            .margin_right(18)
            .margin_bottom(8)
            .x_label_area_size(48)
            .y_label_area_size(up.room())
            .build_cartesian_2d(across.low..across.high, up.low..up.high)?;
        chart
            .configure_mesh()
            .x_desc(self.axes[0])
            .y_desc(self.axes[1])
            .x_labels(8)
            .y_labels(LABELS)
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID_COLOR)
            .axis_style(INK_COLOR)
            .x_label_formatter(&|x| label(x / across.part))
            .y_label_formatter(&|y| label(y / up.part))
            .label_style(FONT.into_font().color(&INK_COLOR))
            .draw()?;
        let stride = self.points.len().div_ceil(MOST_POINTS).max(1);
        let drawable = |([x, y], _): &&([f64; 2], f64)| x.is_finite() && y.is_finite();
        chart.draw_series(self.points.iter().step_by(stride).filter(drawable).map(|([x, y], value)| {
            let share = (value * shade.part - shade.low) / (shade.high - shade.low);
            let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
            let [red, green, blue] = [0, 1, 2].map(|i| (PALE[i] + share * (DARK[i] - PALE[i])) as u8);
            Circle::new((x * across.part, y * up.part), 3, RGBColor(red, green, blue).filled())
        }))?;
        all.present()?;
        drop((head, body));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_stands_where_its_values_are_and_is_darker_where_the_third_is_larger() {
        let points = [([0.0, 0.0], 1.0), ([1.0, 2.0], 3.0), ([0.5, 1.0], 2.0)];
        let ranges = [Some([0.0, 1.0]), None];
        let svg = Scatter { title: "t", axes: ["a", "b"], ranges, shade: "fitness", points: &points }.draw().unwrap();
        let circle = |line: &str| -> Option<(i32, i32, String)> {
            let number = |key: &str| line.split_once(&format!("{key}=\"")).and_then(|(_, rest)| rest.split_once('"'));
            let [x, y] = ["cx", "cy"].map(|key| number(key).and_then(|(x, _)| x.parse().ok()));
            Some((x?, y?, number("fill")?.0.to_owned()))
        };
        let circles: Vec<_> = svg.lines().filter(|line| line.contains("<circle")).filter_map(circle).collect();
        let [(x0, y0, pale), (x1, y1, dark), (x2, y2, _)] = &circles[..] else { panic!("{svg}") };
        assert!(x0 < x2 && x2 < x1 && y0 > y2 && y2 > y1, "{circles:?}");
        let red = |color: &str| u8::from_str_radix(&color[1..3], 16).unwrap();
        assert!(red(pale) > red(dark), "{circles:?}");
        assert!(svg.contains("fitness: from 1 (pale) to 3 (dark)"), "{svg}");
    }

    #[test]
    fn points_of_any_size_can_be_drawn() {
        for x in [f64::MAX, f64::MIN, 5e-324, 0.0, f64::NAN, f64::INFINITY] {
            let points = [([x, 1.0], x), ([-x, x], 0.0)];
            let svg = Scatter { points: &points, ..Scatter::default() }.draw().unwrap();
            assert!(svg.ends_with("</svg>\n"), "{x}");
        }
        assert!(Scatter::default().draw().is_ok());
        let many = vec![([0.5, 0.5], 1.0); 100_000];
        assert!(Scatter { points: &many, ..Scatter::default() }.draw().unwrap().len() < 1_000_000);
    }
}
