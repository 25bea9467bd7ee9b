// SPDX-License-Identifier: MIT
#include "engine/io/vtk/dicom_functional_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace catena::vtk {
namespace {

using gdcm::DataSet;
using gdcm::Tag;

/// Location of a key in classic files, and in functional groups.
struct KeyTags {
  DicomKey key;
  Tag root;
  Tag group, element;
  DicomEncoding encoding;  ///< of the element in the group
};
const Tag kNone(0, 0);
const KeyTags kKeyTags[] = {
    {DicomKey::segment, kNone, Tag(0x62, 0xa), Tag(0x62, 0xb), DicomEncoding::u16},
    {DicomKey::stack, kNone, Tag(0x20, 0x9111), Tag(0x20, 0x9056), DicomEncoding::text},
    {DicomKey::acquisition, Tag(0x20, 0x12), Tag(0x20, 0x9111), Tag(0x20, 0x9156), DicomEncoding::u16},
    {DicomKey::echo_time, Tag(0x18, 0x81), Tag(0x18, 0x9114), Tag(0x18, 0x9082), DicomEncoding::f64},
    {DicomKey::temporal_position, Tag(0x20, 0x100), Tag(0x20, 0x9111), Tag(0x20, 0x9128), DicomEncoding::u32},
    {DicomKey::trigger_time, Tag(0x18, 0x1060), Tag(0x18, 0x9118), Tag(0x20, 0x9153), DicomEncoding::f64},
    {DicomKey::b_value, Tag(0x18, 0x9087), Tag(0x18, 0x9117), Tag(0x18, 0x9087), DicomEncoding::f64},
    {DicomKey::gradient, Tag(0x18, 0x9089), kNone, kNone, DicomEncoding::f64},
    {DicomKey::inversion_time, Tag(0x18, 0x82), kNone, kNone, DicomEncoding::text},
    {DicomKey::flip_angle, Tag(0x18, 0x1314), Tag(0x18, 0x9112), Tag(0x18, 0x1314), DicomEncoding::text},
    {DicomKey::time_offset, kNone, Tag(0x20, 0x9310), Tag(0x20, 0x930d), DicomEncoding::f64},
    {DicomKey::frame_reference_time, Tag(0x54, 0x1300), kNone, kNone, DicomEncoding::text},
    {DicomKey::tube_voltage, Tag(0x18, 0x60), Tag(0x18, 0x9325), Tag(0x18, 0x60), DicomEncoding::text},
    {DicomKey::image_type, Tag(0x8, 0x8), kNone, kNone, DicomEncoding::text},
    {DicomKey::sequence_name, Tag(0x18, 0x24), kNone, kNone, DicomEncoding::text},
    {DicomKey::acquisition_time, Tag(0x8, 0x32), kNone, kNone, DicomEncoding::text},
    {DicomKey::content_time, Tag(0x8, 0x33), kNone, kNone, DicomEncoding::text},
};
/// Vectors of nuclear medicine (NM) files, with one number per frame.
const std::pair<DicomKey, Tag> kVectors[] = {
    {DicomKey::energy_window, Tag(0x54, 0x10)}, {DicomKey::detector, Tag(0x54, 0x20)},    {DicomKey::phase, Tag(0x54, 0x30)},
    {DicomKey::rotation, Tag(0x54, 0x50)},      {DicomKey::rr_interval, Tag(0x54, 0x60)}, {DicomKey::time_slot, Tag(0x54, 0x70)},
    {DicomKey::angular_view, Tag(0x54, 0x90)},  {DicomKey::time_slice, Tag(0x54, 0x100)},
};

std::string key_of(const DicomFunctionalGroups& groups, const KeyTags& tags) {
  if (tags.group != kNone)
    for (const DataSet* set : {groups.per_frame, groups.shared})
      if (set != nullptr)
        for (const DataSet& item : read_items(*set, tags.group)) {
          if (tags.encoding == DicomEncoding::text && !read_text(item, tags.element).empty()) return read_text(item, tags.element);
          if (const auto number = read_number(item, tags.element, tags.encoding)) return fmt::format("{:g}", *number);
        }
  if (tags.root == kNone) return {};
  if (tags.key == DicomKey::b_value || tags.key == DicomKey::gradient)
    return fmt::format("{:g}", fmt::join(read_numbers(groups.root, tags.root, DicomEncoding::f64), " "));
  return read_text(groups.root, tags.root);
}

}  // namespace

void read_frame_keys(const DicomFunctionalGroups& groups, DicomFrame& frame) {
  const auto slot = [&](DicomKey key) -> std::string& { return frame.keys[static_cast<std::size_t>(key)]; };
  for (const KeyTags& tags : kKeyTags) slot(tags.key) = key_of(groups, tags);
  for (const DataSet* set : {groups.per_frame, groups.shared}) {
    if (set == nullptr) continue;
    for (const DataSet& diffusion : read_items(*set, Tag(0x18, 0x9117)))
      for (const DataSet& gradient : read_items(diffusion, Tag(0x18, 0x9076)))
        if (slot(DicomKey::gradient).empty())
          slot(DicomKey::gradient) = fmt::format("{:g}", fmt::join(read_numbers(gradient, Tag(0x18, 0x9089), DicomEncoding::f64), " "));
    for (const Tag& group : {Tag(0x18, 0x9329), Tag(0x18, 0x9226), Tag(0x18, 0x9751)})
      for (const DataSet& type : read_items(*set, group))
        if (const std::string text = read_text(type, Tag(0x8, 0x9007)); !text.empty()) slot(DicomKey::image_type) = text;
  }
}

void read_nm_vectors(const DataSet& root, std::vector<DicomFrame>& frames) {
  for (const auto& [key, tag] : kVectors) {
    const std::vector<double> numbers = read_numbers(root, tag, DicomEncoding::u16);
    if (numbers.size() == frames.size())
      for (DicomFrame& one : frames) one.keys[static_cast<std::size_t>(key)] = fmt::format("{:g}", numbers[one.index]);
  }
}

DicomKeyInfo key_info(DicomKey key) {
  static constexpr DicomKeyInfo kInfo[] = {
      {"segment", ""},         {"stack", ""},        {"acquisition", ""},   {"echo time", " ms"},      {"temporal position", ""},
      {"trigger time", " ms"}, {"b-value", ""},      {"gradient", ""},      {"inversion time", " ms"}, {"flip angle", ""},
      {"time", " s"},          {"time", " ms"},      {"energy window", ""}, {"detector", ""},          {"phase", ""},
      {"rotation", ""},        {"R-R interval", ""}, {"time slot", ""},     {"angular view", ""},      {"time slice", ""},
      {"tube voltage", " kV"}, {"image type", ""},   {"sequence", ""},      {"acquisition time", ""},  {"content time", ""}};
  static_assert(std::size(kInfo) == static_cast<std::size_t>(DicomKey::count));
  return kInfo[static_cast<std::size_t>(key)];
}

}  // namespace catena::vtk
