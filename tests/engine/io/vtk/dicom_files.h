// SPDX-License-Identifier: MIT
/// Small DICOM files for tests: explicit VR, little-endian or big-endian, with elements in any order.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "engine/base/vec.h"

namespace catena::test::vtk_files {

class Dicom {
 public:
  Dicom& text(std::uint32_t tag, const std::string& vr, const std::string& value) {
    return put(tag, vr, value.size() % 2 == 0 ? value : value + (vr == "UI" ? '\0' : ' '), 1);
  }
  /// Adds an element of decimal strings.
  Dicom& decimals(std::uint32_t tag, const std::vector<double>& values, const std::string& vr = "DS") {
    return text(tag, vr, fmt::format("{}", fmt::join(values, "\\")));
  }
  template <class T>
  Dicom& numbers(std::uint32_t tag, const std::string& vr, const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    if (bytes.size() % 2 != 0) bytes += '\0';
    return put(tag, vr, bytes, sizeof(T));
  }
  Dicom& words(std::uint32_t tag, const std::vector<std::uint16_t>& values) { return numbers(tag, "US", values); }
  Dicom& sequence(std::uint32_t tag, const std::vector<Dicom>& items) {
    elements_[tag] = {"SQ", {}, 1, items};
    return *this;
  }
  /// Adds pixels as RLE Lossless: an empty offset table and one fragment.
  Dicom& rle(const std::vector<std::uint16_t>& fragment) {
    std::string bytes(reinterpret_cast<const char*>(fragment.data()), 2 * fragment.size());
    const auto item = [](std::uint16_t element, std::size_t length) {
      return number(0xfffe, 2, false) + number(element, 2, false) + number(static_cast<std::uint32_t>(length), 4, false);
    };
    syntax_ = "1.2.840.10008.1.2.5";
    return put(0x7fe00010, "OB", item(0xe000, 0) + item(0xe000, bytes.size()) + bytes + item(0xe0dd, 0), 1);
  }
  Dicom& without(std::uint32_t tag) {
    elements_.erase(tag);
    return *this;
  }
  /// The bytes of the file with its preamble.
  std::string file(bool big = false) const {
    Dicom meta;
    meta.text(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.2").text(0x00020003, "UI", "1.2.3");
    meta.text(0x00020010, "UI", big ? "1.2.840.10008.1.2.2" : syntax_);
    const std::string head = meta.bytes(false);
    Dicom length;
    length.numbers<std::uint32_t>(0x00020000, "UL", {static_cast<std::uint32_t>(head.size())});
    return std::string(128, '\0') + "DICM" + length.bytes(false) + head + bytes(big);
  }

 private:
  struct Element {
    std::string vr, value;
    std::size_t width = 1;  ///< width of the numbers in `value`
    std::vector<Dicom> items{};
  };
  Dicom& put(std::uint32_t tag, const std::string& vr, const std::string& value, std::size_t width) {
    elements_[tag] = {vr, value, width};
    return *this;
  }
  static std::string ordered(std::string value, std::size_t width, bool big) {
    for (std::size_t at = 0; big && at + width <= value.size(); at += width)
      std::reverse(value.begin() + static_cast<long>(at), value.begin() + static_cast<long>(at + width));
    return value;
  }
  static std::string number(std::uint32_t v, std::size_t width, bool big) {
    return ordered(std::string(reinterpret_cast<const char*>(&v), width), width, big);
  }
  std::string bytes(bool big) const {
    std::string out;
    for (const auto& [tag, element] : elements_) {
      std::string value = ordered(element.value, element.width, big);
      for (const Dicom& item : element.items) {
        const std::string inner = item.bytes(big);
        value += number(0xfffe, 2, big) + number(0xe000, 2, big) + number(static_cast<std::uint32_t>(inner.size()), 4, big) + inner;
      }
      const bool wide = element.vr == "SQ" || element.vr[0] == 'O';
      out += number(tag >> 16, 2, big) + number(tag & 0xffff, 2, big) + element.vr;
      const bool open = element.vr == "OB" && syntax_ == "1.2.840.10008.1.2.5";  // with undefined length
      out += wide ? std::string(2, '\0') + number(open ? 0xffffffff : static_cast<std::uint32_t>(value.size()), 4, big)
                  : number(static_cast<std::uint32_t>(value.size()), 2, big);
      out += value;
    }
    return out;
  }
  std::map<std::uint32_t, Element> elements_;
  std::string syntax_ = "1.2.840.10008.1.2.1";
};

inline constexpr std::uint32_t kPosition = 0x00200032, kOrientation = 0x00200037, kPixelSpacing = 0x00280030, kFrames = 0x00280008,
                               kIntercept = 0x00281052, kSlope = 0x00281053, kModality = 0x00080060, kPixels = 0x7fe00010;

/// A frame of 3 x 2 pixels of 16 bits, 0.25 x 0.5 mm; rows run along x, columns along y; without rescaling.
inline Dicom dicom_image(const std::vector<std::uint16_t>& pixels, const Vec3& at = Vec3(0.0), int number = 1,
                         const std::string& series = "1.2.3") {
  Dicom d;
  d.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2")
      .text(0x00080018, "UI", fmt::format("{}.{}", series, number))
      .text(kModality, "CS", "CT");
  d.text(0x0008103e, "LO", "Chest " + series).text(0x0020000d, "UI", "1.2").text(0x0020000e, "UI", series).text(0x00200052, "UI", "1.2.9");
  d.decimals(0x00200013, {double(number)}, "IS").decimals(kPosition, {at.x, at.y, at.z}).decimals(kOrientation, {1, 0, 0, 0, 1, 0});
  d.words(0x00280002, {1})
      .text(0x00280004, "CS", "MONOCHROME2")
      .words(0x00280010, {2})
      .words(0x00280011, {3})
      .decimals(kPixelSpacing, {0.5, 0.25});
  d.words(0x00280100, {16}).words(0x00280101, {16}).words(0x00280102, {15}).words(0x00280103, {0});
  return d.numbers(kPixels, "OW", pixels);
}

/// One slice of stored values: value = 2 stored - 1000.
inline std::string dicom(int number, const Vec3& at, const std::vector<int>& stored, const std::string& series = "1.2.3") {
  return dicom_image({stored.begin(), stored.end()}, at, number, series).decimals(kIntercept, {-1000}).decimals(kSlope, {2}).file();
}

}  // namespace catena::test::vtk_files
