// SPDX-License-Identifier: MIT
#include "engine/io/vtk/dicom_element.h"

#include <gdcmSequenceOfItems.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace catena::vtk {
namespace {

std::string_view without_padding(std::string_view text) {
  constexpr std::string_view kPadding(" \t\r\n\0", 5);
  const std::size_t first = text.find_first_not_of(kPadding), last = text.find_last_not_of(kPadding);
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

DicomEncoding encoding_of(const gdcm::DataElement& element, DicomEncoding expected) {
  const gdcm::VR vr = element.GetVR();
  if (vr == gdcm::VR::US) return DicomEncoding::u16;
  if (vr == gdcm::VR::UL) return DicomEncoding::u32;
  if (vr == gdcm::VR::FL) return DicomEncoding::f32;
  if (vr == gdcm::VR::FD) return DicomEncoding::f64;
  if (vr == gdcm::VR::DS || vr == gdcm::VR::IS) return DicomEncoding::text;
  return expected;
}

template <class T>
std::vector<double> binary_numbers(const std::string& bytes) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    numbers.push_back(static_cast<double>(value));
  }
  return numbers;
}

std::vector<double> decimal_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    const std::string word(without_padding(std::string_view(text).substr(at, end - at)));
    char* stop = nullptr;
    const double value = std::strtod(word.c_str(), &stop);
    if (word.empty() || *stop != 0) return {};
    numbers.push_back(value);
    at = end + 1;
  }
  return numbers;
}

}  // namespace

std::string read_bytes(const gdcm::DataSet& set, gdcm::Tag tag) {
  if (!set.FindDataElement(tag)) return {};
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetPointer() == nullptr) return {};
  return {value->GetPointer(), static_cast<std::size_t>(static_cast<std::uint32_t>(value->GetLength()))};
}

std::string read_text(const gdcm::DataSet& set, gdcm::Tag tag) { return std::string(without_padding(read_bytes(set, tag))); }

std::vector<double> read_numbers(const gdcm::DataSet& set, gdcm::Tag tag, DicomEncoding encoding) {
  const std::string bytes = read_bytes(set, tag);
  if (bytes.empty()) return {};
  std::vector<double> numbers;
  switch (encoding_of(set.GetDataElement(tag), encoding)) {
    case DicomEncoding::text:
      numbers = decimal_numbers(bytes);
      break;
    case DicomEncoding::u16:
      numbers = binary_numbers<std::uint16_t>(bytes);
      break;
    case DicomEncoding::u32:
      numbers = binary_numbers<std::uint32_t>(bytes);
      break;
    case DicomEncoding::f32:
      numbers = binary_numbers<float>(bytes);
      break;
    case DicomEncoding::f64:
      numbers = binary_numbers<double>(bytes);
      break;
  }
  for (const double number : numbers)
    if (!std::isfinite(number)) return {};
  return numbers;
}

std::optional<double> read_number(const gdcm::DataSet& set, gdcm::Tag tag, DicomEncoding encoding) {
  const std::vector<double> numbers = read_numbers(set, tag, encoding);
  return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

std::vector<gdcm::DataSet> read_items(const gdcm::DataSet& set, gdcm::Tag tag, std::size_t max_items) {
  std::vector<gdcm::DataSet> items;
  if (!set.FindDataElement(tag) || set.GetDataElement(tag).IsEmpty()) return items;
  const gdcm::SmartPointer<gdcm::SequenceOfItems> sequence = set.GetDataElement(tag).GetValueAsSQ();
  if (sequence == nullptr) return items;
  for (auto item = sequence->Begin(); item != sequence->End() && items.size() < max_items; ++item)
    items.push_back(item->GetNestedDataSet());
  return items;
}

}  // namespace catena::vtk
