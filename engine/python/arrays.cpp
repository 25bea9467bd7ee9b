// SPDX-License-Identifier: MIT
/// catena.field: NumPy arrays of any type and strides as grids, read in place.
#include <algorithm>
#include <array>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "engine/field/grid/grid_from_slices.h"
#include "engine/io/volume/load_field.h"
#include "engine/python/module.h"

namespace catena::python {
namespace {

/// An array as voxels: component c of voxel i, j, k is at byte base + i sx + j sy + k sz + c sc.
struct Voxels {
  const char* base = nullptr;
  field::Index3 size{0, 0, 0};
  py::ssize_t sx = 0, sy = 0, sz = 0, sc = 0;
  int components = 1;    ///< 1, or 2 or 3 for vectors
  bool swapped = false;  ///< whether the array has the other byte order
};

/// A 16-bit floating-point number (IEEE 754).
struct Half {
  std::uint16_t bits = 0;
  explicit operator float() const { return glm::unpackHalf1x16(bits); }
};

template <class T>
T number_at(const char* from, bool swapped) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <class T>
void read_layers(const Voxels& v, int z, std::span<float> out) {
  std::size_t n = 0;
  for (int k = z; n < out.size(); ++k)
    for (int j = 0; j < v.size.y; ++j) {
      const char* row = v.base + k * v.sz + j * v.sy;
      for (int i = 0; i < v.size.x; ++i, row += v.sx)
        for (int c = 0; c < (v.components == 1 ? 1 : 3); ++c)
          out[n++] = c < v.components ? static_cast<float>(number_at<T>(row + c * v.sc, v.swapped)) : 0.f;
    }
}

using Reader = void (*)(const Voxels&, int, std::span<float>);
Reader reader_of(const py::dtype& type) {
  switch (type.kind() * 16 + static_cast<int>(type.itemsize())) {
    case 'f' * 16 + 2:
      return read_layers<Half>;
    case 'f' * 16 + 4:
      return read_layers<float>;
    case 'f' * 16 + 8:
      return read_layers<double>;
    case 'b' * 16 + 1:
    case 'u' * 16 + 1:
      return read_layers<std::uint8_t>;
    case 'i' * 16 + 1:
      return read_layers<std::int8_t>;
    case 'u' * 16 + 2:
      return read_layers<std::uint16_t>;
    case 'i' * 16 + 2:
      return read_layers<std::int16_t>;
    case 'u' * 16 + 4:
      return read_layers<std::uint32_t>;
    case 'i' * 16 + 4:
      return read_layers<std::int32_t>;
    case 'u' * 16 + 8:
      return read_layers<std::uint64_t>;
    case 'i' * 16 + 8:
      return read_layers<std::int64_t>;
    default:
      return nullptr;
  }
}

/// Maps the array's axes to voxels. A missing dimension, or one with a single voxel, gets a stride of 0: its voxel appears twice.
Voxels voxels_of(const py::array& array, const std::string& axes, const std::string& name, bool vectors) {
  if (axes != "zyx" && axes != "xyz") throw Failure(Error{name + ": axes is \"" + axes + "\"; \"zyx\" or \"xyz\" was expected"});
  Voxels v;
  const int axes_of_voxels = static_cast<int>(array.ndim()) - (vectors ? 1 : 0);
  const py::ssize_t last = array.ndim() > 0 ? array.shape(array.ndim() - 1) : 0;
  if (axes_of_voxels < 1 || axes_of_voxels > 3 || (vectors && last != 2 && last != 3))
    throw Failure(Error{name + ": the array has the shape " + format_shape(array) +
                        (vectors ? "; one to three dimensions and a last one of 2 or 3 components were expected for vectors"
                                 : "; one to three dimensions were expected, or a fourth of 2 or 3 components for vectors")});
  int size[3] = {2, 2, 2};
  py::ssize_t strides[3] = {0, 0, 0};
  for (int axis = 0; axis < axes_of_voxels; ++axis) {
    if (array.shape(axis) > 65536) throw Failure(Error{name + ": an axis has more than 65536 voxels"});
    const int to = axes == "xyz" ? axis : axes_of_voxels - 1 - axis;
    size[to] = static_cast<int>(array.shape(axis));
    strides[to] = array.strides(axis);
    if (size[to] == 1) size[to] = 2, strides[to] = 0;
  }
  v.base = static_cast<const char*>(array.data());
  v.size = {size[0], size[1], size[2]};
  v.sx = strides[0], v.sy = strides[1], v.sz = strides[2];
  if (vectors) v.components = static_cast<int>(last), v.sc = array.strides(array.ndim() - 1);
  return v;
}

field::Mapping mapping_of(const py::object& affine, const std::string& name) {
  if (affine.is_none()) return {};
  const NumberArray m = to_numbers(affine, name + ": affine");
  if (m.ndim() != 2 || m.shape(0) != 4 || m.shape(1) != 4)
    throw Failure(Error{name + ": the affine is no 4 x 4 matrix; the map from (i, j, k, 1) to the world was expected"});
  for (int column = 0; column < 4; ++column)
    if (m.at(3, column) != (column == 3 ? 1 : 0)) throw Failure(Error{name + ": the affine's last row is not 0 0 0 1, as it was expected"});
  Mat3 linear{1.0};
  Vec3 origin{0.0};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) linear[column][row] = m.at(row, column);
    origin[row] = m.at(row, 3);
  }
  return field::Mapping::from_linear(linear, origin);
}

Field with_interpolation(Field field, const std::string& words, const std::string& name) {
  const auto chosen = words == "linear"    ? field::Interpolation::linear
                      : words == "nearest" ? field::Interpolation::nearest
                                           : field::Interpolation::cubic;
  if (chosen == field::Interpolation::cubic && words != "cubic")
    throw Failure(Error{name + ": interpolation is \"" + words + "\"; \"linear\", \"nearest\" or \"cubic\" was expected"});
  if (chosen == field::Interpolation::linear) return field;
  if (field.any.vector) {
    if (chosen == field::Interpolation::nearest) throw Failure(Error{name + ": vectors are not read by the nearest voxel"});
    field.any.vector = unwrap(field.any.vector->grid()->as_cubic());
  } else if (chosen == field::Interpolation::cubic) {
    field.any.scalar = unwrap(field.any.scalar->grid()->as_cubic());
  } else {
    field.any.scalar = field.any.scalar->grid()->with_interpolation(chosen);
  }
  return field;
}

Field from_array(const py::array& array, const std::string& axes, const py::object& affine, const std::string& name,
                 const std::string& interpolation, bool vectors) {
  const Reader reader = reader_of(array.dtype());
  if (reader == nullptr)
    throw Failure(
        Error{name + ": the array holds " + py::cast<std::string>(py::str(array.dtype())) + "; real numbers were expected (astype)"});
  Voxels voxels = voxels_of(array, axes, name, vectors);
  voxels.swapped = array.dtype().byteorder() == '>';
  const field::Mapping mapping = mapping_of(affine, name);
  const py::gil_scoped_release unlocked;
  field::SliceSource layers;
  layers.size = voxels.size;
  layers.is_vector = vectors;
  layers.read = [&](int z, std::span<float> out) { reader(voxels, z, out); };
  return with_interpolation({unwrap(field::make_grid_from_slices(name, mapping, layers))}, interpolation, name);
}

}  // namespace

Field to_field(const py::handle& value, const std::string& name) {
  if (py::isinstance<Field>(value)) return py::cast<Field>(value);
  return py::cast<Field>(py::module_::import("catena").attr("field")(value, py::arg("name") = name));
}

void add_arrays(py::module_& m) {
  m.def("_from_array", from_array, py::arg("array"), py::arg("axes"), py::arg("affine"), py::arg("name"), py::arg("interpolation"),
        py::arg("vectors"));
  m.def(
      "_from_file",
      [](const py::object& file, const std::string& grid, int step, const std::string& interpolation) {
        const std::string path = to_path(file);
        const py::gil_scoped_release unlocked;
        field::LoadRequest request;
        request.path = path;
        request.grid = grid;
        request.step = step;
        return with_interpolation({unwrap(field::load(request))}, interpolation, path);
      },
      py::arg("path"), py::arg("grid"), py::arg("step"), py::arg("interpolation"));
}

}  // namespace catena::python
