// SPDX-License-Identifier: MIT
/// Placed glyphs against their rendered pixels, and fallbacks without a font.
#include "render/text/typesetter.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/support.h"

namespace catena::test::typesetter_test {

using namespace catena::render;

/// Bounds of a text's covered pixels, relative to its box.
struct Ink {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
};

Ink ink_of(Typesetter& typesetter, std::string_view text, const TextStyle& style) {
  Ink ink;
  for (const PlacedGlyph& g : typesetter.layout(text, style).glyphs) {
    const GlyphBitmap bitmap = typesetter.font(style.bold)->rasterize(g.glyph, style.size_px, 0, 0);
    for (int y = 0; y < bitmap.height; ++y)
      for (int x = 0; x < bitmap.width; ++x) {
        if (bitmap.coverage[std::size_t(y) * std::size_t(bitmap.width) + std::size_t(x)] < 128) continue;
        ink.left = std::min(ink.left, g.x + bitmap.left + x);
        ink.right = std::max(ink.right, g.x + bitmap.left + x + 1);
        ink.top = std::min(ink.top, g.y - bitmap.top + y);
        ink.bottom = std::max(ink.bottom, g.y - bitmap.top + y + 1);
      }
  }
  return ink;
}

TEST(Utf8, DecodesEveryLengthAndReplacesInvalidBytes) {
  EXPECT_EQ(decode_utf8("aé€𝄞"), (std::vector<char32_t>{U'a', U'é', U'€', U'\U0001d11e'}));
  EXPECT_EQ(decode_utf8("\xff"
                        "a\xc3"),
            (std::vector<char32_t>{0xfffd, U'a', 0xfffd}));
  EXPECT_EQ(decode_utf8("\xe2\x82"), (std::vector<char32_t>{0xfffd, 0xfffd}));
  EXPECT_EQ(decode_utf8("\xc0\xaf"), (std::vector<char32_t>{0xfffd, 0xfffd})) << "overlong";
  EXPECT_EQ(decode_utf8("\xed\xa0\x80").front(), char32_t(0xfffd)) << "a surrogate";
}

TEST(Typesetter, TheBoxHasTheCapHeightAndTheAdvances) {
  Typesetter typesetter;
  for (const double size : {12.0, 20.5, 60.0}) {
    const TextStyle style{size, false, 0};
    const TextExtent extent = typesetter.measure("HEIH", style);
    ASSERT_GT(extent.width, 0) << typesetter.error_message();
    const Ink ink = ink_of(typesetter, "HEIH", style);
    // the outlines' height is hinted to whole pixels
    EXPECT_NEAR(ink.top, 0, 1.5);
    EXPECT_NEAR(ink.bottom, extent.height, 1);
    EXPECT_GE(ink.left, -0.5);
    EXPECT_LE(ink.right, extent.width + 0.5);
    EXPECT_GE(ink.right - ink.left, extent.width - 0.25 * size) << "side bearings alone";
    EXPECT_NEAR(extent.height, 0.729 * size, 1e-3 * size) << "DejaVu Sans: capitals of 1493 / 2048";
    // descenders extend below the box
    EXPECT_GT(ink_of(typesetter, "gjp", style).bottom, extent.height + 0.15 * size);
    EXPECT_LE(ink_of(typesetter, "gjp", style).bottom, extent.height + extent.descent + 1);
  }
}

TEST(Typesetter, WidthsAddUpAndKerningReducesThem) {
  Typesetter typesetter;
  const TextStyle style{24, false, 0};
  const auto width = [&](std::string_view text) { return typesetter.measure(text, style).width; };
  EXPECT_NEAR(width("0123"), 4 * width("0"), 1e-9) << "figures are as wide as each other";
  EXPECT_NEAR(width("HH"), 2 * width("H"), 1e-9);
  EXPECT_LT(width("AV"), width("A") + width("V") - 0.5);
  EXPECT_GT(typesetter.measure("H", {24, true, 0}).width, width("H")) << "bold is wider";
  EXPECT_NEAR(typesetter.measure("HH", {48, false, 0}).width, 2 * width("HH"), 1e-9);
}

TEST(Typesetter, LinesAreAligned) {
  Typesetter typesetter;
  const TextLayout one = typesetter.layout("H", {20, false, 0});
  for (const double align : {0.0, 0.5, 1.0}) {
    const TextLayout two = typesetter.layout("HHH\nH", {20, false, align});
    ASSERT_EQ(two.glyphs.size(), 4u);
    EXPECT_NEAR(two.glyphs[3].x, align * 2 * one.extent.width, 1e-9);
    EXPECT_GT(two.glyphs[3].y - two.glyphs[0].y, 20);
    EXPECT_EQ(two.extent.height, two.glyphs[3].y);
    EXPECT_NEAR(two.extent.width, 3 * one.extent.width, 1e-9);
  }
}

TEST(GlyphAtlas, EveryGlyphKeepsItsPixelsAndAFullAtlasIsReset) {
  Typesetter typesetter;
  const Font* font = typesetter.font(false);
  ASSERT_NE(font, nullptr) << typesetter.error_message();
  GlyphAtlas& atlas = typesetter.atlas();
  const auto check = [&](char32_t code, double size, int quarter, double halo) {
    const GlyphAtlas::Entry* entry = atlas.get(*font, font->glyph_index(code), size, quarter, halo);
    ASSERT_NE(entry, nullptr);
    const GlyphBitmap bitmap = font->rasterize(font->glyph_index(code), size, 0.25 * quarter, halo);
    ASSERT_EQ(entry->width, bitmap.width);
    ASSERT_LE(entry->y + entry->height, atlas.height());
    for (int y = 0; y < bitmap.height; ++y)
      for (int x = 0; x < bitmap.width; ++x)
        ASSERT_EQ(atlas.pixels()[std::size_t(entry->y + y) * GlyphAtlas::kWidth + std::size_t(entry->x + x)],
                  bitmap.coverage[std::size_t(y * bitmap.width + x)]);
  };
  for (char32_t c = U'A'; c <= U'Z'; ++c)
    for (const int quarter : {0, 3})
      for (const double halo : {0.0, 2.0}) check(c, 30, quarter, halo);
  for (char32_t c = U'A'; c <= U'Z'; ++c) check(c, 30, 0, 0);
  EXPECT_EQ(atlas.generation(), 0u);
  const std::uint64_t version = atlas.version();
  check(U'A', 30, 0, 0);
  EXPECT_EQ(atlas.version(), version) << "made once";
  // a halo extends a glyph by its stated width
  const GlyphBitmap plain = font->rasterize(font->glyph_index(U'H'), 30, 0, 0), wide = font->rasterize(font->glyph_index(U'H'), 30, 0, 2);
  EXPECT_NEAR(wide.width, plain.width + 4, 1);
  EXPECT_NEAR(wide.height, plain.height + 4, 1);

  for (double size = 300; atlas.generation() == 0 && size < 400; ++size)
    for (char32_t c = U'A'; c <= U'Z'; ++c) ASSERT_NE(atlas.get(*font, font->glyph_index(c), size, 0, 0), nullptr);
  EXPECT_EQ(atlas.generation(), 1u);
  EXPECT_EQ(atlas.height(), GlyphAtlas::kMaxHeight);
  check(U'Q', 30, 1, 0);
}

TEST(Typesetter, WithoutAFontThereIsOneNoteAndNoText) {
  const TemporaryFolder folder;
  write_file(folder / "fonts.conf", "<?xml version=\"1.0\"?><!DOCTYPE fontconfig SYSTEM \"fonts.dtd\"><fontconfig></fontconfig>");
  ::setenv("FONTCONFIG_FILE", (folder / "fonts.conf").c_str(), 1);
  Typesetter typesetter;
  const TextLayout set = typesetter.layout("text", {20, false, 0});
  ::unsetenv("FONTCONFIG_FILE");
  EXPECT_TRUE(set.glyphs.empty());
  EXPECT_EQ(set.extent.width, 0);
  EXPECT_NE(typesetter.error_message().find("text is left out"), std::string::npos) << typesetter.error_message();
  EXPECT_NE(typesetter.error_message().find("fonts-dejavu-core"), std::string::npos);
  EXPECT_EQ(typesetter.error_message().find('\n'), std::string::npos);

  // a file that is not a font
  write_file(folder / "no.ttf", "no font");
  const auto font = Font::open({folder / "no.ttf", 0});
  ASSERT_FALSE(font);
  EXPECT_NE(font.error().message.find("no.ttf"), std::string::npos);
}

TEST(Typesetter, AnUnknownFamilyFallsBackAndAChangeResetsTheAtlas) {
  Typesetter typesetter;
  const double width = typesetter.measure("Hamburg", {20, false, 0}).width;
  typesetter.set_family("No Such Family 4711");
  EXPECT_GT(typesetter.measure("Hamburg", {20, false, 0}).width, 0) << typesetter.error_message();
  EXPECT_TRUE(typesetter.error_message().empty());
  typesetter.set_family("DejaVu Sans");
  EXPECT_EQ(typesetter.measure("Hamburg", {20, false, 0}).width, width);
}

}  // namespace catena::test::typesetter_test
