//! Textures of bodies: a picture of a file, a pattern, and what cannot be one.

use std::path::Path;

use souple_io::picture::{Colour, Image, Pattern, TextureFigure};
use souple_scene::{Scene, read_text};

const BLOCK: &str = r#"format = 1
[world]
period = "10 ms"
[bodies.block]
mesh = { generate = "box", size = [1, 1, 1], cells = [2, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
texture = { pattern = "spots", size = "5 cm" }
"#;

fn scene(texture: &str, folder: &Path) -> Result<Scene, String> {
    let text = BLOCK.replace("pattern = \"spots\", size = \"5 cm\"", texture);
    read_text("scene.toml", &text, folder, &[]).map_err(|errors| errors.to_string())
}

/// A pattern has its two colours, those of an organ where none are told; a picture is read, and is one of the files that a scene was
/// made from: another picture makes another scene.
#[test]
fn textures_are_pictures_and_patterns() {
    let folder = std::env::temp_dir().join(format!("souple-textures-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let told = scene("pattern = \"fibres\", size = \"5 cm\", colours = [\"#ff0000\", \"#0000ff\"]", &folder)
        .unwrap();
    let texture = told.bodies[0].texture.as_ref().unwrap();
    let colours = [[255, 0, 0], [0, 0, 255]].map(Colour::from_screen);
    assert_eq!(texture.figure, TextureFigure::Pattern(Pattern::Fibres, colours));
    assert_eq!(texture.size, 0.05);

    let hash = |shade: u8| {
        let image = Image { width: 2, height: 1, pixels: vec![[shade, 0, 0], [0, 0, 0]] };
        image.write_png(&folder.join("skin.png")).unwrap();
        let read = scene("file = \"skin.png\", size = 0.1", &folder).unwrap();
        let texture = read.bodies[0].texture.clone().unwrap();
        assert_eq!(texture.figure, TextureFigure::Picture(image.into()));
        assert!(read.inputs.files.iter().any(|file| file.path.ends_with("skin.png")));
        read.scene_sha256
    };
    assert_ne!(hash(10), hash(20));

    let refused = |texture: &str, words: &str| {
        let message = scene(texture, &folder).err().expect("the scene is refused");
        assert!(message.contains(words), "`{words}` is not in:\n{message}");
    };
    refused("size = 1", "`file` or `pattern`");
    refused("file = \"skin.png\", pattern = \"spots\", size = 1", "`file` or `pattern`");
    refused("pattern = \"spots\"", "size");
    refused("pattern = \"stripes\", size = 1", "stripes");
    refused("pattern = \"spots\", size = -1", "size");
    refused("pattern = \"spots\", size = 1, colours = [\"red\"]", "two colours of six hexadecimal digits");
    refused("file = \"skin.png\", size = 1, colours = [\"#000000\", \"#ffffff\"]", "colours of its own");
    refused("file = \"none.png\", size = 1", "none.png");
    std::fs::write(folder.join("text.png"), "no picture").unwrap();
    refused("file = \"text.png\", size = 1", "expected a whole PNG file");
    let wide = Image { width: 4097, height: 1, pixels: vec![[0; 3]; 4097] };
    wide.write_png(&folder.join("wide.png")).unwrap();
    refused("file = \"wide.png\", size = 1", "4097 x 1 pixels");
    std::fs::remove_dir_all(&folder).unwrap();
}
