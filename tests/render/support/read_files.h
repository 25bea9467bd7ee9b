// SPDX-License-Identifier: MIT
/// Image files read by the format libraries, independent of Catena's code.
#pragma once
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <png.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::test {

struct DeepPng {
  std::uint32_t width = 0, height = 0;
  int bits = 0, channels = 0;
  std::vector<std::uint16_t> values;        ///< as stored; also for 8 bits
  std::map<std::string, std::string> text;  ///< text chunks
};

inline DeepPng read_deep_png(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  CATENA_ASSERT(file != nullptr);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  CATENA_ASSERT(!setjmp(png_jmpbuf(png)));
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  DeepPng image{
      png_get_image_width(png, info), png_get_image_height(png, info), png_get_bit_depth(png, info), png_get_channels(png, info), {}, {}};
  png_bytepp rows = png_get_rows(png, info);
  const std::size_t row = std::size_t(image.width) * std::size_t(image.channels);
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::size_t i = 0; i < row; ++i)
      image.values.push_back(image.bits == 16 ? std::uint16_t(rows[y][2 * i] << 8 | rows[y][2 * i + 1]) : rows[y][i]);
  png_textp text = nullptr;
  const int count = png_get_text(png, info, &text, nullptr);
  for (int i = 0; i < count; ++i) image.text[text[i].key] = text[i].text;
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return image;
}

struct ExrImage {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;
  std::string comments;
};

inline ExrImage read_exr(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const auto box = file.header().dataWindow();
  ExrImage image{box.max.x - box.min.x + 1, box.max.y - box.min.y + 1, {}, {}};
  if (Imf::hasComments(file.header())) image.comments = Imf::comments(file.header());
  Imf::FrameBuffer frame;
  const Imf::ChannelList& list = file.header().channels();
  for (auto it = list.begin(); it != list.end(); ++it) {
    CATENA_ASSERT(it.channel().type == Imf::FLOAT);
    auto& values = image.channels[it.name()];
    values.resize(std::size_t(image.width) * std::size_t(image.height));
    frame.insert(it.name(),
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float), sizeof(float) * std::size_t(image.width)));
  }
  file.setFrameBuffer(frame);
  file.readPixels(box.min.y, box.max.y);
  return image;
}

}  // namespace catena::test
