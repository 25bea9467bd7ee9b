/// Where a log's bytes come from: a file, or memory. Off the tick.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace catena::haptics::log {

class Source {
 public:
  virtual ~Source() = default;
  virtual std::uint64_t size() const = 0;  ///< as it was when it was opened
  /// False where the bytes cannot be read.
  virtual bool read(std::uint64_t offset, void* to, std::size_t bytes) = 0;
};

Result<std::unique_ptr<Source>> open_file(const std::string& path);
std::unique_ptr<Source> from_memory(std::string_view bytes);  ///< which outlive it

}  // namespace catena::haptics::log
