/// UTF-8 text to placed glyphs. A text's box reaches from the capitals' height of its first line to the baseline of its last, and is
/// as wide as its widest line's advances: what is centred by it looks centred, descenders hang below. Pixels, x right, y down.
/// Fonts are opened when first used. Without a font everything has no extent and no glyphs, and `fault` says why. Frame thread.
#pragma once
#include <optional>
#include <string_view>

#include "render/text/glyph_atlas.h"

namespace catena::render {

struct TextStyle {
  double size_px = 16;
  bool bold = false;
  double align = 0;  ///< of several lines: 0 left, 0.5 centred, 1 right
};

struct TextExtent {
  double width = 0, height = 0;
  double descent = 0;  ///< below the box
};

/// A glyph's pen on its baseline, from the box's top left corner.
struct SetGlyph {
  std::uint32_t glyph = 0;
  double x = 0, y = 0;
};

struct SetText {
  std::vector<SetGlyph> glyphs;
  TextExtent extent;
};

class Typesetter {
 public:
  /// Another family drops the fonts (and so the atlas).
  void use_family(const std::string& family);
  SetText set(std::string_view text, const TextStyle& style);
  TextExtent measure(std::string_view text, const TextStyle& style) { return set(text, style).extent; }
  /// The font of a style, or none.
  const Font* font(bool bold);
  GlyphAtlas& atlas() { return atlas_; }
  /// One sentence, once a font was asked for that is not there.
  const std::string& fault() const { return fault_; }

 private:
  struct Face {
    bool tried = false;
    std::unique_ptr<Font> font;
  };
  std::string family_ = "DejaVu Sans", fault_;
  Face faces_[2];
  GlyphAtlas atlas_;
};

}  // namespace catena::render
