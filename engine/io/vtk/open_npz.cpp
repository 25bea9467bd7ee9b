// SPDX-License-Identifier: MIT
// Opens NumPy's .npz: arrays in a zip file; each becomes an image with the array's name.
#include <fmt/format.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <zip.h>

#include <memory>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/io/sandbox/npy.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

struct CloseZip {
  void operator()(zip_t* file) const { zip_discard(file); }
};
struct CloseMember {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

/// Returns the bytes of a member, at most as many as its directory entry states.
Result<std::vector<std::byte>> member_bytes(zip_t* file, zip_uint64_t index, std::uint64_t size) {
  const std::unique_ptr<zip_file_t, CloseMember> member(zip_fopen_index(file, index, 0));
  if (!member) return Error{"cannot be unpacked"};
  std::vector<std::byte> bytes;
  constexpr std::size_t kPiece = 1 << 20;
  while (bytes.size() < size) {
    const std::size_t at = bytes.size(), piece_size = std::min<std::uint64_t>(kPiece, size - at);
    bytes.resize(at + piece_size);
    const zip_int64_t got = zip_fread(member.get(), bytes.data() + at, piece_size);
    if (got <= 0) return Error{"is truncated or damaged"};
    bytes.resize(at + static_cast<std::size_t>(got));
  }
  return bytes;
}

vtkSmartPointer<vtkImageData> make_image_data(const std::string& name, const sandbox::NpyHeader& head, std::span<const std::byte> numbers) {
  const field::Size3 n = sandbox::npy_grid_size(head);
  const auto values = vtkSmartPointer<vtkFloatArray>::New();
  values->SetName(name.c_str());
  values->SetNumberOfComponents(head.components == 1 ? 1 : 3);
  values->SetNumberOfTuples(n.x * n.y * n.z);
  sandbox::decode_npy(head, numbers, {values->GetPointer(0), static_cast<std::size_t>(sandbox::npy_float_count(head))});
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(n.x), static_cast<int>(n.y), static_cast<int>(n.z));
  image->GetPointData()->AddArray(values);
  return image;
}

}  // namespace

Result<ImportedData> open_npz(const Source& source) {
  const auto failed = [&](const std::string& what) { return Error{one_line(source.display_name + ": " + what)}; };
  int code = 0;
  const std::unique_ptr<zip_t, CloseZip> file(zip_open(source.path.c_str(), ZIP_RDONLY, &code));
  if (!file) return failed("cannot be read: not a zip file of arrays (.npz)");
  ImportedData opened;
  const zip_int64_t count = zip_get_num_entries(file.get(), 0);
  constexpr zip_int64_t kMaxMembers = 1000;
  if (count > kMaxMembers) return failed(fmt::format("contains {} arrays, expected at most {}", count, kMaxMembers));
  for (zip_int64_t i = 0; i < count; ++i) {
    zip_stat_t about;
    if (zip_stat_index(file.get(), static_cast<zip_uint64_t>(i), 0, &about) != 0) return failed("has a damaged directory");
    std::string name = about.name;
    if (!name.ends_with(".npy")) continue;
    name.resize(name.size() - 4);
    if (!source.grid.empty() && name != source.grid) continue;
    const std::string what = "the array " + in_quotes(name);
    if (const auto room = check_memory_available(source.display_name + ": " + what, static_cast<double>(about.size)); !room)
      return room.error();
    const auto bytes = member_bytes(file.get(), static_cast<zip_uint64_t>(i), about.size);
    if (!bytes) return failed(what + " " + bytes.error().message);
    const auto head = sandbox::read_npy_header(*bytes, source.axes_xyz);
    // skip scalars, texts and lists, which are not fields
    constexpr std::int64_t kMaxAxis = 1 << 24;
    if (!head || head->size.y < 2 || std::max({head->size.x, head->size.y, head->size.z}) > kMaxAxis) {
      opened.notes.push_back(what + " was left out" + (head ? ": the array is not an image" : ": the array " + head.error().message));
      continue;
    }
    const std::span<const std::byte> numbers = std::span(*bytes).subspan(head->data_offset);
    const double expected_bytes =
        double(head->size.x) * double(head->size.y) * double(head->size.z) * head->components * double(head->number_bytes);
    if (static_cast<double>(numbers.size()) != expected_bytes)
      return failed(fmt::format("{} has {} bytes of data, expected {:.0f}", what, numbers.size(), expected_bytes));
    opened.blocks.push_back({make_image_data(name, *head, numbers), {}});
  }
  if (opened.blocks.empty())
    return failed(source.grid.empty() ? "contains no array that is an image" : "there is no grid " + in_quotes(source.grid));
  return opened;
}

}  // namespace catena::vtk
