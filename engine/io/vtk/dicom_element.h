/// Private to this room: values of a DICOM data set, by tag. What is missing, empty or malformed has no value; nothing throws.
#pragma once
#include <gdcmDataSet.h>

#include <optional>
#include <string>
#include <vector>

namespace catena::vtk {

/// How the values of an element are encoded where the file does not say (implicit VR).
enum class DicomEncoding { text, u16, u32, f32, f64 };

/// The whole value as text without padding; empty: missing.
std::string read_text(const gdcm::DataSet& set, gdcm::Tag tag);
/// All numbers of a value; empty: missing, or one of them is not a finite number.
std::vector<double> read_numbers(const gdcm::DataSet& set, gdcm::Tag tag, DicomEncoding encoding = DicomEncoding::text);
/// The first number.
std::optional<double> read_number(const gdcm::DataSet& set, gdcm::Tag tag, DicomEncoding encoding = DicomEncoding::text);
/// The items of a sequence, at most `max_items`.
std::vector<gdcm::DataSet> read_items(const gdcm::DataSet& set, gdcm::Tag tag, std::size_t max_items = 1);
/// The bytes of a value as GDCM has them in memory: little-endian for the element's VR.
std::string read_bytes(const gdcm::DataSet& set, gdcm::Tag tag);

}  // namespace catena::vtk
