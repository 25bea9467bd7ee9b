#include "render/text/typesetter.h"

#include <algorithm>

#include "render/text/utf8.h"

namespace catena::render {

void Typesetter::use_family(const std::string& family) {
  if (family == family_) return;
  family_ = family;
  fault_.clear();
  atlas_.clear();
  for (Face& face : faces_) face = {};
}

const Font* Typesetter::font(bool bold) {
  Face& face = faces_[bold ? 1 : 0];
  if (!face.tried) {
    face.tried = true;
    const auto open = [&]() -> Result<Font> {
      CATENA_TRY(const FontFile file, find_font(family_, bold));
      return Font::open(file);
    };
    if (auto font = open()) {
      face.font = std::make_unique<Font>(std::move(*font));
    } else {
      fault_ = font.error().message;
    }
  }
  return face.font.get();
}

SetText Typesetter::set(std::string_view text, const TextStyle& style) {
  SetText out;
  const Font* font = this->font(style.bold);
  if (font == nullptr || text.empty()) return out;
  const FontMeasures measures = font->measures(style.size_px);

  // lines from the left
  std::vector<std::size_t> line_starts{0};
  std::vector<double> widths;
  double x = 0, y = measures.cap_height;
  std::uint32_t before = 0;
  for (const char32_t code : code_points(text)) {
    if (code == U'\n') {
      widths.push_back(x);
      line_starts.push_back(out.glyphs.size());
      x = 0;
      y += measures.line_height;
      before = 0;
      continue;
    }
    const std::uint32_t glyph = font->glyph_of(code);
    if (before != 0) x += font->kerning(before, glyph, style.size_px);
    out.glyphs.push_back({glyph, x, y});
    x += font->advance(glyph, style.size_px);
    before = glyph;
  }
  widths.push_back(x);
  line_starts.push_back(out.glyphs.size());
  out.extent = {*std::max_element(widths.begin(), widths.end()), y, measures.descent};

  // and aligned
  for (std::size_t line = 0; line < widths.size(); ++line)
    for (std::size_t i = line_starts[line]; i < line_starts[line + 1]; ++i)
      out.glyphs[i].x += style.align * (out.extent.width - widths[line]);
  return out;
}

}  // namespace catena::render
