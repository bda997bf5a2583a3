//! A contact sheet: pictures of several moments in rows, under one title and beside one legend.

use souple_io::picture::{Image, Picture, Theme};

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
        let fit = |grid: &Self| {
            let [width, height] = grid.cell(size);
            (width * PICTURE[1]).min(height * PICTURE[0])
        };
        let grids = (1..=count.max(1)).map(|columns| Self::of_columns(columns, count));
        grids
            .reduce(|best, grid| if fit(&grid) > fit(&best) { grid } else { best })
            .unwrap_or(Self::square(1))
    }

    fn cell(self, [width, height]: [usize; 2]) -> [usize; 2] {
        [width / self.columns, height / self.rows]
    }
}

/// A sheet before its pictures are drawn.
pub struct Sheet {
    grid: Grid,
    /// Of all pictures together [pixels].
    size: [usize; 2],
    /// Of each picture [pixels].
    pub cell: [usize; 2],
    title: Option<Image>,
    legend: Option<Image>,
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
    ) -> Result<Self, Refusal> {
        let count = pictures.len();
        let strip = |width: usize| (!title.is_empty()).then(|| Image::title_strip(title, width, theme));
        let legend = |height: usize| pictures.iter().find_map(|picture| picture.legend_strip(height));
        let width_of = |image: &Option<Image>| image.as_ref().map_or(0, |image| image.width);
        let Some(whole) = size else {
            let (grid, cell) = (Grid::square(count), about(count, None));
            let size = [cell[0] * grid.columns, cell[1] * grid.rows];
            let legend = legend(size[1]);
            return Ok(Self { grid, size, cell, title: strip(size[0] + width_of(&legend)), legend });
        };
        let asked = format!("{},{}", whole[0], whole[1]);
        if whole.iter().any(|side| !(1..=LARGEST).contains(side)) {
            let message = format!("a sheet of {} x {} pixels cannot be drawn", whole[0], whole[1]);
            return Err(Refusal::request("size", asked, format!("1 to {LARGEST} pixels"), message));
        }
        let title = strip(whole[0]);
        let height = whole[1].saturating_sub(title.as_ref().map_or(0, |title| title.height));
        let legend = legend(height);
        let size = [whole[0].saturating_sub(width_of(&legend)), height];
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
        Ok(Self { grid, size, cell, title, legend })
    }

    pub fn has_legend(&self) -> bool {
        self.legend.is_some()
    }

    /// The sheet of the pictures as they are drawn.
    pub fn of(self, images: &[Image]) -> Image {
        let sheet = Image::sheet(images, self.grid.columns).grown(self.size);
        let sheet = self.legend.map_or_else(|| sheet.clone(), |legend| sheet.beside(&legend));
        match self.title {
            Some(title) => title.above(&sheet),
            None => sheet,
        }
    }
}

#[cfg(test)]
mod tests {
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
        let sheet = Sheet::new(&pictures(4), Some([401, 303]), ("A title", Theme::Light));
        let sheet = sheet.unwrap_or_else(|_| panic!("refused"));
        let [width, height] = sheet.cell;
        let image = Image { width, height, pixels: vec![[1, 2, 3]; width * height] };
        let whole = sheet.of(&vec![image; 4]);
        assert_eq!((whole.width, whole.height, whole.pixels.len()), (401, 303, 401 * 303));
        for (count, size) in [(9, [100, 60]), (4, [0, 0]), (4, [99_999, 10])] {
            assert!(
                Sheet::new(&pictures(count), Some(size), ("", Theme::Light)).is_err(),
                "{count} {size:?}"
            );
        }
    }
}
