// SPDX-License-Identifier: MIT
/// Private to this module: looks up DICOM elements in the functional groups of frames, and reads the keys that distinguish frames.
#pragma once
#include "engine/io/vtk/dicom_element.h"
#include "engine/io/vtk/dicom_headers.h"

namespace catena::vtk {

/// Elements of one frame: searched in its own functional groups, the shared ones, and the root data set of the file, in this order.
struct DicomFunctionalGroups {
  const gdcm::DataSet& root;
  const gdcm::DataSet* shared;
  const gdcm::DataSet* per_frame;

  /// Returns the first nonempty result of `find` on the items of `group`, or its result on the root data set.
  template <class Find>
  auto first(gdcm::Tag group, const Find& find) const -> decltype(find(root)) {
    for (const gdcm::DataSet* set : {per_frame, shared})
      if (set != nullptr)
        for (const gdcm::DataSet& item : read_items(*set, group))
          if (auto found = find(item); static_cast<bool>(found)) return found;
    return find(root);
  }
  /// Returns all numbers of an element, if there are at least `min_count`.
  std::optional<std::vector<double>> numbers(gdcm::Tag group, gdcm::Tag tag, std::size_t min_count,
                                             DicomEncoding encoding = DicomEncoding::text) const {
    return first(group, [&](const gdcm::DataSet& set) {
      std::vector<double> found = read_numbers(set, tag, encoding);
      return found.size() >= min_count ? std::optional(std::move(found)) : std::nullopt;
    });
  }
  /// Returns the first number of an element.
  std::optional<double> number(gdcm::Tag group, gdcm::Tag tag, DicomEncoding encoding = DicomEncoding::text) const {
    const auto found = numbers(group, tag, 1, encoding);
    return found ? std::optional(found->front()) : std::nullopt;
  }
  /// Returns the text of an element; empty: missing.
  std::string text(gdcm::Tag group, gdcm::Tag tag) const {
    return first(group,
                 [&](const gdcm::DataSet& set) {
                   std::string found = read_text(set, tag);
                   return found.empty() ? std::nullopt : std::optional(std::move(found));
                 })
        .value_or(std::string());
  }
};

/// Fills in the keys that can distinguish the frame from others at its position.
void read_frame_keys(const DicomFunctionalGroups& groups, DicomFrame& frame);
/// Fills in the keys from the vectors of NM files, which have one number per frame.
void read_nm_vectors(const gdcm::DataSet& root, std::vector<DicomFrame>& frames);

}  // namespace catena::vtk
