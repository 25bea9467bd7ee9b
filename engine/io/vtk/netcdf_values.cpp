// SPDX-License-Identifier: MIT
#include "engine/io/vtk/netcdf_values.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <vtkTypeTraits.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::vtk {
namespace {

/// The numbers of an attribute; long double represents 64-bit integers exactly.
struct Numbers {
  nc_type type = NC_NAT;
  std::vector<long double> list;
};

Numbers numbers_at(int file, int variable, const char* name) {
  Numbers numbers;
  std::size_t count = 0;
  constexpr std::size_t kMaxAttributeNumbers = 10'000;
  if (nc_inq_att(file, variable, name, &numbers.type, &count) != NC_NOERR || count == 0 || count > kMaxAttributeNumbers) return {};
  const auto read = [&]<class T>(T, auto get) {
    std::vector<T> raw(count);
    if (get(file, variable, name, raw.data()) == NC_NOERR) numbers.list.assign(raw.begin(), raw.end());
  };
  if (numbers.type == NC_CHAR) {
    std::string text(count, ' ');
    if (nc_get_att_text(file, variable, name, text.data()) != NC_NOERR) return {};
    if (const auto number = parse_double(text.substr(0, text.find('\0')))) numbers.list = {static_cast<long double>(*number)};
  } else if (numbers.type == NC_UINT64) {
    read(0ULL, nc_get_att_ulonglong);
  } else if (numbers.type >= NC_BYTE && numbers.type <= NC_INT64 && numbers.type != NC_FLOAT && numbers.type != NC_DOUBLE) {
    read(0LL, nc_get_att_longlong);
  } else if (numbers.type == NC_FLOAT || numbers.type == NC_DOUBLE) {
    read(0.0, nc_get_att_double);
  }
  return numbers;
}

/// Returns the rank of a numeric type by the values that it can represent.
int width_of(nc_type type) {
  switch (type) {
    case NC_BYTE:
    case NC_UBYTE:
      return 1;
    case NC_SHORT:
    case NC_USHORT:
      return 2;
    case NC_INT:
    case NC_UINT:
      return 3;
    case NC_INT64:
    case NC_UINT64:
      return 4;
    case NC_FLOAT:
      return 5;
    case NC_DOUBLE:
      return 6;
    default:
      return 0;
  }
}

/// Returns an attribute's number as a stored number of the variable; an integer that differs only in signedness is converted with the same
/// bits.
template <class T>
long double as_stored(long double v) {
  if constexpr (std::is_integral_v<T>) {
    const long double all = std::ldexp(1.0L, 8 * sizeof(T)), minimum = std::numeric_limits<T>::min(),
                      maximum = std::numeric_limits<T>::max();
    if (v < minimum && v >= -all / 2) return v + all;
    if (v > maximum && v < all) return v - all;
    return v;
  } else {
    return static_cast<long double>(static_cast<T>(v));
  }
}

template <class T>
class TypedVariable {
 public:
  TypedVariable(const NetcdfHyperslab& part, nc_type type) : part_(part), type_(type) {
    const auto at = [&](const char* name) { return numbers_at(part.file, part.variable, name); };
    const Numbers factor = at("scale_factor"), offset = at("add_offset");
    scale_ = read_netcdf_scale(part.file, part.variable);
    value_type_ = width_of(factor.type) >= width_of(offset.type) ? factor.type : offset.type;
    // missing values
    const Numbers fill = at("_FillValue");
    add_holes(fill, false);
    add_holes(at("missing_value"), true);
    if (fill.list.empty()) add_default_fill();
    // valid range
    const Numbers range = at("valid_range");
    if (range.list.size() == 2) {
      limit(range.type, range.list[0], range.list[1]);
    } else {
      const Numbers minimum = at("valid_min"), maximum = at("valid_max");
      if (minimum.list.size() == 1) limit(minimum.type, minimum.list[0], std::nullopt);
      if (maximum.list.size() == 1) limit(maximum.type, std::nullopt, maximum.list[0]);
    }
  }

  Result<vtkSmartPointer<vtkDataArray>> read(std::vector<std::string>& notes) {
    std::size_t all = 1;
    for (const std::size_t n : part_.count) all *= n;
    CATENA_CHECK(check_memory_available("the variable", static_cast<double>(all) * (sizeof(T) + 8)));
    const auto stored = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtkTypeTraits<T>::VTK_TYPE_ID));
    stored->SetNumberOfTuples(static_cast<vtkIdType>(all));
    T* numbers = static_cast<T*>(stored->GetVoidPointer(0));
    if (const int code = nc_get_vara(part_.file, part_.variable, part_.start.data(), part_.count.data(), numbers); code != NC_NOERR)
      return Error{nc_strerror(code)};
    std::size_t filled = 0, out_of_range = 0;
    for (std::size_t i = 0; i < all; ++i) {
      if (is_hole(numbers[i]))
        ++filled;
      else if (is_beyond(numbers[i]))
        ++out_of_range;
    }
    if (out_of_range > 0)
      notes.push_back(fmt::format("{} of {} values are outside the valid range of the file ({} .. {}) and are read as holes", out_of_range,
                                  all, in_words(least_), in_words(most_)));
    if (filled + out_of_range == 0 && scale_.is_identity()) return stored;
    constexpr bool kSmall = std::is_same_v<T, float> || (std::is_integral_v<T> && sizeof(T) <= 2);
    const bool single = kSmall && (scale_.is_identity() || value_type_ == NC_FLOAT);
    const auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(single ? VTK_FLOAT : VTK_DOUBLE));
    values->SetNumberOfTuples(stored->GetNumberOfTuples());
    if (single)
      unpack(numbers, all, static_cast<float*>(values->GetVoidPointer(0)));
    else
      unpack(numbers, all, static_cast<double*>(values->GetVoidPointer(0)));
    return values;
  }

 private:
  /// Represents every stored number exactly.
  using Wide = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, long double, double>;

  void add_holes(const Numbers& numbers, bool in_either_units) {
    for (const long double number : numbers.list) {
      holes_.push_back(static_cast<Wide>(as_stored<T>(number)));
      // often doubles, their fill value, or both are rounded to single precision
      if (std::is_same_v<T, double>) rounded_holes_.push_back(static_cast<float>(number));
      if (in_either_units && !scale_.is_identity()) value_holes_.push_back(static_cast<double>(number));
    }
  }

  void add_default_fill() {
    if (sizeof(T) == 1) return;
    // the fill value has the type of the file; T may be its unsigned form
    int without = 0;
    alignas(8) unsigned char raw[8] = {};
    if (nc_inq_var_fill(part_.file, part_.variable, &without, raw) != NC_NOERR || without != 0) return;
    T fill;
    std::memcpy(&fill, raw, sizeof fill);
    holes_.push_back(static_cast<Wide>(fill));
  }

  void limit(nc_type type, std::optional<long double> minimum, std::optional<long double> maximum) {
    limits_values_ = !scale_.is_identity() && type == value_type_ && width_of(type) > width_of(type_);
    const auto bound = [&](std::optional<long double> v, std::optional<Wide>& to) {
      if (v && !std::isnan(*v)) to = static_cast<Wide>(limits_values_ ? *v : as_stored<T>(*v));
    };
    bound(minimum, least_);
    bound(maximum, most_);
    if (least_ && most_ && *least_ > *most_) least_ = most_ = std::nullopt;
  }

  double value_of(T v) const { return static_cast<double>(v) * scale_.factor + scale_.offset; }

  bool is_hole(T v) const {
    for (const Wide hole : holes_)
      if (static_cast<Wide>(v) == hole) return true;
    for (const float hole : rounded_holes_)
      if (static_cast<float>(v) == hole) return true;
    for (const double hole : value_holes_)
      if (std::fabs(value_of(v) - hole) <= slack()) return true;
    return false;
  }
  bool is_beyond(T v) const {
    if (!least_ && !most_) return false;
    const Wide number = limits_values_ ? static_cast<Wide>(value_of(v)) : static_cast<Wide>(v);
    const Wide slack_here = limits_values_ ? static_cast<Wide>(slack()) : 0;
    return (least_ && number < *least_ - slack_here) || (most_ && number > *most_ + slack_here);
  }
  /// Rounding tolerance of a value: a small fraction of the step between two stored integers.
  double slack() const { return std::is_integral_v<T> ? 1e-3 * std::fabs(scale_.factor) : 0; }

  static std::string in_words(const std::optional<Wide>& v) { return v ? fmt::format("{:.6g}", static_cast<double>(*v)) : "any"; }

  template <class Value>
  void unpack(const T* stored, std::size_t count, Value* values) const {
    for (std::size_t i = 0; i < count; ++i) {
      const bool bad = is_hole(stored[i]) || is_beyond(stored[i]);
      const Value value = scale_.is_identity() ? static_cast<Value>(stored[i]) : static_cast<Value>(value_of(stored[i]));
      values[i] = bad ? std::numeric_limits<Value>::quiet_NaN() : value;
    }
  }

  const NetcdfHyperslab& part_;
  nc_type type_, value_type_ = NC_NAT;
  NetcdfScale scale_;
  std::vector<Wide> holes_;
  std::vector<float> rounded_holes_;
  std::vector<double> value_holes_;
  std::optional<Wide> least_, most_;
  bool limits_values_ = false;
};

}  // namespace

std::string read_netcdf_text(int file, int variable, const char* name) {
  std::size_t count = 0;
  nc_type type = NC_NAT;
  constexpr std::size_t kMaxTextBytes = 1000;
  if (nc_inq_att(file, variable, name, &type, &count) != NC_NOERR) return {};
  if (type == NC_STRING && count == 1) {
    char* words = nullptr;
    if (nc_get_att_string(file, variable, name, &words) != NC_NOERR) return {};
    const std::string text = words != nullptr ? std::string(words).substr(0, kMaxTextBytes) : std::string();
    nc_free_string(1, &words);
    return text;
  }
  if (type != NC_CHAR || count > kMaxTextBytes) return {};
  std::string text(count, '\0');
  if (nc_get_att_text(file, variable, name, text.data()) != NC_NOERR) return {};
  return text.substr(0, text.find('\0'));
}

NetcdfScale read_netcdf_scale(int file, int variable) {
  const Numbers factor = numbers_at(file, variable, "scale_factor"), offset = numbers_at(file, variable, "add_offset");
  NetcdfScale scale;
  if (factor.list.size() == 1 && std::isfinite(factor.list[0])) scale.factor = static_cast<double>(factor.list[0]);
  if (offset.list.size() == 1 && std::isfinite(offset.list[0])) scale.offset = static_cast<double>(offset.list[0]);
  return scale;
}

Result<vtkSmartPointer<vtkDataArray>> read_netcdf_values(const NetcdfHyperslab& part, std::vector<std::string>& notes) {
  nc_type type = NC_NAT;
  if (const int code = nc_inq_vartype(part.file, part.variable, &type); code != NC_NOERR) return Error{nc_strerror(code)};
  if (type > NC_MAX_ATOMIC_TYPE) {
    // an enumeration is read as its base type
    char name[NC_MAX_NAME + 1];
    std::size_t bytes = 0, members = 0;
    nc_type base = NC_NAT;
    type = nc_inq_enum(part.file, type, name, &base, &bytes, &members) == NC_NOERR ? base : NC_NAT;
  }
  const std::string valid_range_text = read_netcdf_text(part.file, part.variable, "_Unsigned");
  const bool make_unsigned = valid_range_text == "true" || valid_range_text == "True" || valid_range_text == "TRUE",
             make_signed = valid_range_text == "false" || valid_range_text == "False" || valid_range_text == "FALSE";
  const auto as = [&]<class T>(T) { return TypedVariable<T>(part, type).read(notes); };
  switch (type) {
    case NC_BYTE:
      return make_unsigned ? as(static_cast<unsigned char>(0)) : as(static_cast<signed char>(0));
    case NC_UBYTE:
      return make_signed ? as(static_cast<signed char>(0)) : as(static_cast<unsigned char>(0));
    case NC_SHORT:
      return make_unsigned ? as(static_cast<unsigned short>(0)) : as(static_cast<short>(0));
    case NC_USHORT:
      return make_signed ? as(static_cast<short>(0)) : as(static_cast<unsigned short>(0));
    case NC_INT:
      return make_unsigned ? as(0U) : as(0);
    case NC_UINT:
      return make_signed ? as(0) : as(0U);
    case NC_INT64:
      return make_unsigned ? as(0ULL) : as(0LL);
    case NC_UINT64:
      return make_signed ? as(0LL) : as(0ULL);
    case NC_FLOAT:
      return as(0.0F);
    case NC_DOUBLE:
      return as(0.0);
    default:
      return vtkSmartPointer<vtkDataArray>();
  }
}

}  // namespace catena::vtk
