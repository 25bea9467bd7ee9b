#include "engine/field/formats.h"

#include "engine/base/text.h"
#include "engine/field/loaders.h"

namespace catena::field {

namespace {

std::vector<FileFormat>& registry() {
  static std::vector<FileFormat> formats{vdb_format(), nifti_format(), raw_format()};
  return formats;
}

}  // namespace

void add_format(FileFormat format) { registry().push_back(std::move(format)); }

const FileFormat* format_of(std::string_view path, std::string_view* ending) {
  for (const FileFormat& format : registry())
    for (const std::string_view one : format.endings)
      if (has_ending(path, one)) {
        if (ending != nullptr) *ending = one;
        return &format;
      }
  return nullptr;
}

bool is_field_file(std::string_view path) { return format_of(path) != nullptr; }

bool needs_layout(std::string_view path) {
  const FileFormat* format = format_of(path);
  return format != nullptr && format->needs_layout;
}

std::vector<std::string_view> field_endings(bool bare) {
  std::vector<std::string_view> out;
  for (const FileFormat& format : registry())
    if (!bare || !format.needs_layout) out.insert(out.end(), format.endings.begin(), format.endings.end());
  return out;
}

std::string field_file_words() { return alternatives(field_endings()); }

}  // namespace catena::field
