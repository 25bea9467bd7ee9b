// SPDX-License-Identifier: MIT
/// Private to this module: values of a DICOM data set, by tag. Missing, empty or malformed elements have no value; nothing throws.
#pragma once
#include <gdcmDataSet.h>

#include <optional>
#include <string>
#include <vector>

namespace catena::vtk {

/// Encoding of an element's values when the file does not specify it (implicit VR).
enum class DicomEncoding { text, u16, u32, f32, f64 };

/// Returns the complete value as text without padding; empty: missing.
std::string read_text(const gdcm::DataSet& set, gdcm::Tag tag);
/// Returns all numbers of a value; empty: missing, or one of them is not a finite number.
std::vector<double> read_numbers(const gdcm::DataSet& set, gdcm::Tag tag, DicomEncoding encoding = DicomEncoding::text);
/// Returns the first number of a value.
std::optional<double> read_number(const gdcm::DataSet& set, gdcm::Tag tag, DicomEncoding encoding = DicomEncoding::text);
/// Returns the items of a sequence, at most `max_items`.
std::vector<gdcm::DataSet> read_items(const gdcm::DataSet& set, gdcm::Tag tag, std::size_t max_items = 1);
/// Returns the bytes of a value as GDCM stores them: little-endian for the element's VR.
std::string read_bytes(const gdcm::DataSet& set, gdcm::Tag tag);

}  // namespace catena::vtk
