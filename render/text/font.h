// SPDX-License-Identifier: MIT
/// Font file with its metrics and its glyphs as coverage bitmaps (FreeType). Outlines are hinted vertically only: positions along the line
/// are exact. Sizes in pixels per em, positions in pixels, x right; "top" counts upwards from the baseline. Frame thread.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

/// Location of an installed font, found by fontconfig as the nearest match of a family ("DejaVu Sans"). The Error of find_font() says what
/// to install.
struct FontFile {
  std::string path;
  int index = 0;  ///< index of the face within the file
};
/// Returns the installed font that matches the family and weight best.
Result<FontFile> find_font(const std::string& family, bool bold);

/// Vertical metrics of a font, pixels.
struct FontMetrics {
  double cap_height = 0;   ///< height of capitals and digits above the baseline
  double descent = 0;      ///< depth below the baseline, positive
  double line_height = 0;  ///< distance between baselines
};

/// Coverage bitmap of a glyph.
struct GlyphBitmap {
  int width = 0, height = 0;
  int left = 0, top = 0;               ///< offset of the bitmap's upper left corner from the pen
  std::vector<std::uint8_t> coverage;  ///< rows from the top; 255: fully covered
};

/// One face of a font file.
class Font {
 public:
  /// Opens the face. An Error gives the path.
  static Result<Font> open(const FontFile& file);
  ~Font();
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;

  /// Returns the metrics at a font size.
  FontMetrics metrics(double size_px) const;
  /// Returns the glyph of a code point; 0 (rendered as an empty box) if the font has none.
  std::uint32_t glyph_index(char32_t code) const;
  /// Returns the advance width of a glyph, pixels.
  double advance(std::uint32_t glyph, double size_px) const;
  /// Returns the distance to add between two glyphs, pixels; 0 if the font has no kerning.
  double kerning(std::uint32_t left, std::uint32_t right, double size_px) const;
  /// Returns the bitmap of a glyph with its pen `shift_px` right of a pixel's edge, widened by `halo_px` on all sides. Empty for blanks.
  GlyphBitmap rasterize(std::uint32_t glyph, double size_px, double shift_px, double halo_px) const;

 private:
  Font();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::render
