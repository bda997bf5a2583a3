//! A contact sheet: pictures of several moments in rows, under one title and beside one legend.

use souple_io::picture::{ArrowKey, Image, LEGEND, Marks, Picture, Theme};

use crate::command::Refusal;

/// Letters of pictures on a sheet, in those of pictures that are looked at by themselves: a sheet is looked at as a whole.
pub const LETTERS: f64 = 2.4;

/// Pictures of a sheet where no size is asked for, the largest, and the width of a sheet of many [pixels].
const PICTURE: [usize; 2] = [640, 480];
const WIDTH: usize = 1600;
/// Largest side of a sheet [pixels].
const LARGEST: usize = 16384;
/// Smaller pictures show nothing [pixels].
const LEAST: [usize; 2] = [48, 32];

/// How many pictures stand side by side and one below the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Grid {
    columns: usize,
    rows: usize,
}

impl Grid {
    fn of_columns(columns: usize, count: usize) -> Self {
        Self { columns, rows: count.div_ceil(columns).max(1) }
    }

    /// About as wide as high, in pictures.
    fn square(count: usize) -> Self {
        let columns = (1..=count).find(|columns| columns * columns >= count);
        Self::of_columns(columns.unwrap_or(1), count)
    }

    /// That leaves most to pictures of the usual shape.
    fn within(size: [usize; 2], count: usize) -> Self {
        let fit = |grid: &Self| grid.fit(size);
        let grids = (1..=count.max(1)).map(|columns| Self::of_columns(columns, count));
        grids
            .reduce(|best, grid| if fit(&grid) > fit(&best) { grid } else { best })
            .unwrap_or(Self::square(1))
    }

    /// How large pictures of the usual shape are in its cells, more or less.
    fn fit(self, size: [usize; 2]) -> usize {
        let [width, height] = self.cell(size);
        (width * PICTURE[1]).min(height * PICTURE[0])
    }

    fn cell(self, [width, height]: [usize; 2]) -> [usize; 2] {
        [width / self.columns, height / self.rows]
    }
}

/// A legend that is worth another shape of a sheet leaves so much more to its pictures.
const WORTH: f64 = 1.05;

/// A sheet before its pictures are drawn.
pub struct Sheet {
    grid: Grid,
    /// Of all pictures together [pixels].
    size: [usize; 2],
    /// Height of all, with title and legend, where it is asked for [pixels].
    whole: usize,
    /// Of each picture [pixels].
    pub cell: [usize; 2],
    title: Option<Image>,
    /// On the right of the pictures.
    beside: Option<Image>,
    /// Below them.
    below: Option<Image>,
    common: Common,
    background: [u8; 3],
}

/// What pictures of a sheet have in common and is drawn once, below them.
#[derive(Clone, Debug, Default)]
pub struct Common {
    marks: Marks,
    key: Option<ArrowKey>,
}

impl Common {
    /// Takes marks and keys from pictures.
    pub fn taken(pictures: &mut [Picture]) -> Self {
        let marks = pictures.first().map(|picture| picture.marks).unwrap_or_default();
        let key = pictures.iter().find_map(|picture| picture.key.clone());
        for picture in pictures {
            (picture.marks, picture.key) = (Marks::default(), None);
        }
        Self { marks, key }
    }
}

/// About the size of each of so many pictures, on a sheet of a size [pixels].
pub fn about(count: usize, size: Option<[usize; 2]>) -> [usize; 2] {
    match size {
        Some(size) => Grid::within(size, count).cell(size).map(|side| side.max(1)),
        None => {
            let width = (WIDTH / Grid::square(count).columns).min(PICTURE[0]);
            [width, width * PICTURE[1] / PICTURE[0]]
        }
    }
}

impl Sheet {
    /// Room for pictures on a sheet of a size, or of one that suits them; the legend is that of the first picture that has one.
    ///
    /// # Errors
    /// Pictures would be too small to show anything.
    pub fn new(
        pictures: &[Picture],
        size: Option<[usize; 2]>,
        (title, theme): (&str, Theme),
        common: Common,
    ) -> Result<Self, Refusal> {
        let count = pictures.len();
        let background = pictures.first().map_or([255; 3], Picture::background);
        let strip = |width: usize| (!title.is_empty()).then(|| Image::title_strip(title, width, theme));
        let beside = |height: usize| pictures.iter().find_map(|picture| picture.legend_strip(height));
        let width_of = |image: &Option<Image>| image.as_ref().map_or(0, |image| image.width);
        let height_of = |image: &Option<Image>| image.as_ref().map_or(0, |image| image.height);
        let Some(whole) = size else {
            let (grid, cell) = (Grid::square(count), about(count, None));
            let size = [cell[0] * grid.columns, cell[1] * grid.rows];
            let beside = beside(size[1]);
            let title = strip(size[0] + width_of(&beside));
            let whole = size[1];
            return Ok(Self { grid, size, whole, cell, title, beside, below: None, common, background });
        };
        let asked = format!("{},{}", whole[0], whole[1]);
        if whole.iter().any(|side| !(1..=LARGEST).contains(side)) {
            let message = format!("a sheet of {} x {} pixels cannot be drawn", whole[0], whole[1]);
            return Err(Refusal::request("size", asked, format!("1 to {LARGEST} pixels"), message));
        }
        let title = strip(whole[0]);
        let marks = pictures.first().and_then(|of| of.marks_strip(common.marks, common.key.as_ref(), whole));
        let taken = height_of(&title) + marks.map_or(0, |marks| marks.image.height);
        let height = whole[1].saturating_sub(taken);
        let mut beside = beside(height);
        let mut below = pictures.iter().find_map(|picture| picture.legend_below(whole[0]));
        let besides = [whole[0].saturating_sub(width_of(&beside)), height];
        let above = [whole[0], height.saturating_sub(height_of(&below))];
        let fit = |size: [usize; 2]| Grid::within(size, count).fit(size) as f64;
        let is_above = below.is_some() && (beside.is_none() || fit(above) > WORTH * fit(besides));
        let size = if is_above { above } else { besides };
        if is_above {
            beside = None;
        } else {
            below = None;
        }
        let grid = Grid::within(size, count);
        let cell = grid.cell(size);
        if cell[0] < LEAST[0] || cell[1] < LEAST[1] {
            let [[width, height], [least_width, least_height]] = [cell, LEAST];
            let message = format!(
                "a sheet of {} x {} pixels leaves {width} x {height} to each of {count} pictures",
                whole[0], whole[1]
            );
            let expected =
                format!("{least_width} x {least_height} for each at least, beside title and legend");
            return Err(Refusal::request("size", asked, expected, message));
        }
        let whole = whole[1];
        Ok(Self { grid, size, whole, cell, title, beside, below, common, background })
    }

    /// The sheet of the pictures as they are drawn, and what has no room on it.
    pub fn of(self, pictures: &[Picture], images: &[Image]) -> (Image, Vec<&'static str>) {
        let background = self.background;
        let sheet = Image::sheet(images, self.grid.columns, background).grown(self.size, background);
        let mut left_out = Vec::new();
        if pictures.iter().any(|of| of.legend.is_some()) && self.beside.is_none() && self.below.is_none() {
            left_out.push(LEGEND);
        }
        let mut sheet = self.beside.map_or_else(|| sheet.clone(), |legend| sheet.beside(&legend));
        if let Some(legend) = self.below {
            sheet = sheet.above(&legend);
        }
        let Common { marks, key } = self.common;
        let strip =
            pictures.first().and_then(|of| of.marks_strip(marks, key.as_ref(), [sheet.width, self.whole]));
        if let Some(strip) = strip {
            left_out.extend(strip.left_out);
            sheet = sheet.above(&strip.image);
        }
        (self.title.map_or_else(|| sheet.clone(), |title| title.above(&sheet)), left_out)
    }
}

#[cfg(test)]
mod tests {
    use souple_io::picture::{Legend, LegendPlace};

    use super::*;

    /// Sheets are filled by pictures of about the usual shape, whatever shape they have themselves.
    #[test]
    fn sheets_are_filled() {
        let grid = |columns, rows| Grid { columns, rows };
        assert_eq!(Grid::within([1920, 1440], 9), grid(3, 3));
        assert_eq!(Grid::within([1600, 300], 4), grid(4, 1));
        assert_eq!(Grid::within([300, 900], 4), grid(1, 4));
        assert_eq!(Grid::within([10, 10], 1), grid(1, 1));
        assert_eq!(Grid::square(5), grid(3, 2));
        assert_eq!((about(4, None), about(16, None)), ([640, 480], [400, 300]));
    }

    /// A sheet is as large as asked for, to the pixel; one that is too small for its pictures is refused.
    #[test]
    fn sheets_have_the_size_asked_for() {
        let pictures = |count: usize| vec![Picture { samples_per_pixel: 1, ..Picture::default() }; count];
        let sheet = Sheet::new(&pictures(4), Some([401, 303]), ("A title", Theme::Light), Common::default());
        let sheet = sheet.unwrap_or_else(|_| panic!("refused"));
        let [width, height] = sheet.cell;
        let image = Image { width, height, pixels: vec![[1, 2, 3]; width * height] };
        let (whole, left_out) = sheet.of(&pictures(4), &vec![image; 4]);
        assert!(left_out.is_empty());
        assert_eq!((whole.width, whole.height, whole.pixels.len()), (401, 303, 401 * 303));
        for (count, size) in [(9, [100, 60]), (4, [0, 0]), (4, [99_999, 10])] {
            assert!(
                Sheet::new(&pictures(count), Some(size), ("", Theme::Light), Common::default()).is_err(),
                "{count} {size:?}"
            );
        }
    }

    /// On sheets of any shape the legend leaves more than half to the pictures, and marks are drawn once, below them.
    #[test]
    fn legends_and_marks_leave_room_to_pictures() {
        let legend = Some(Legend {
            title: "von Mises stress".to_owned(),
            unit: "Pa".to_owned(),
            range: Some((0.0, 1e5)),
            place: LegendPlace::Apart,
            ..Legend::default()
        });
        let key = Some(ArrowKey { title: "velocity".to_owned(), unit: "m/s".to_owned(), scale: 1.0 });
        let marks = Marks { triad: true, scale_bar: true };
        let picture =
            Picture { legend, key, marks, samples_per_pixel: 1, size: [100, 75], ..Picture::default() };
        for (count, size, is_above) in
            [(3, [400, 900], true), (4, [300, 600], true), (9, [1200, 800], false), (3, [1500, 400], false)]
        {
            let mut pictures = vec![picture.clone(); count];
            let common = Common::taken(&mut pictures);
            assert!(pictures.iter().all(|of| of.key.is_none() && of.marks == Marks::default()));
            let sheet = Sheet::new(&pictures, Some(size), ("A title", Theme::Light), common);
            let sheet = sheet.unwrap_or_else(|_| panic!("refused"));
            assert_eq!((sheet.below.is_some(), sheet.beside.is_some()), (is_above, !is_above), "{size:?}");
            let [width, height] = sheet.size;
            assert!(2 * width * height > size[0] * size[1], "{size:?} {width} {height}");
            let [width, height] = sheet.cell;
            pictures.iter_mut().for_each(|of| of.size = [width, height]);
            let image = Image { width, height, pixels: vec![[1, 2, 3]; width * height] };
            let (whole, left_out) = sheet.of(&pictures, &vec![image; count]);
            assert_eq!([whole.width, whole.height], size);
            assert!(left_out.is_empty(), "{size:?} {left_out:?}");
        }
    }
}
