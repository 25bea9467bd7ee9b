// SPDX-License-Identifier: MIT
#include "render/shader_compiler/compile_shader.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "engine/base/text.h"

namespace catena::render {
namespace {

constexpr std::string_view kTop = "shaders/";
constexpr int kVersion = 460;

std::optional<std::string> text_of(const std::string& path) {
  auto text = read_text_file(path, "a shader");
  if (!text) return std::nullopt;
  return std::move(*text);
}

std::optional<EShLanguage> stage_of(std::string_view name) {
  if (name.ends_with(".vert")) return EShLangVertex;
  if (name.ends_with(".frag")) return EShLangFragment;
  if (name.ends_with(".comp")) return EShLangCompute;
  return std::nullopt;
}

/// glslang, initialized once per process and finalized at its end.
struct Library {
  Library() { glslang::InitializeProcess(); }
  ~Library() { glslang::FinalizeProcess(); }
};

class Includes final : public glslang::TShader::Includer {
 public:
  explicit Includes(std::string folder) : folder_(std::move(folder)) {}
  IncludeResult* includeLocal(const char* header, const char*, std::size_t) override {
    if (!std::string_view(header).starts_with(kTop)) return nullptr;
    const std::string name = header + kTop.size();
    auto text = text_of(folder_ + "/" + name);
    if (!text) return nullptr;
    files.insert(name);
    auto* kept = new std::string(std::move(*text));
    return new IncludeResult(folder_ + "/" + name, kept->data(), kept->size(), kept);
  }
  void releaseInclude(IncludeResult* result) override {
    if (result == nullptr) return;
    delete static_cast<std::string*>(result->userData);
    delete result;
  }

  std::set<std::string> files;

 private:
  std::string folder_;
};

/// Returns the first line "ERROR: place: message" of a log, without "ERROR: ".
std::string first_error(std::string_view log, const std::string& path) {
  constexpr std::string_view kError = "ERROR: ";
  const auto at = log.find(kError);
  if (at == std::string_view::npos) return path + ": the compiler refuses it without a reason";
  std::string_view line = log.substr(at + kError.size());
  line = line.substr(0, line.find('\n'));
  while (line.ends_with(' ')) line.remove_suffix(1);
  return std::string(line);
}

}  // namespace

Result<CompiledShader> compile_shader(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name;
  const auto stage = stage_of(name);
  if (!stage) return Error{path + ": expected a name that ends with .vert, .frag or .comp"};
  const auto text = text_of(path);
  if (!text) return Error{path + ": cannot be read"};

  static const Library library;
  constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  glslang::TShader shader(*stage);
  const char* words[] = {text->c_str()};
  const int lengths[] = {static_cast<int>(text->size())};
  const char* names[] = {path.c_str()};
  shader.setStringsWithLengthsAndNames(words, lengths, names, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, *stage, glslang::EShClientVulkan, kVersion);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  Includes includes(folder);
  if (!shader.parse(GetDefaultResources(), kVersion, false, kMessages, includes)) return Error{first_error(shader.getInfoLog(), path)};
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(kMessages)) return Error{first_error(program.getInfoLog(), path)};

  CompiledShader compiled;
  glslang::GlslangToSpv(*program.getIntermediate(*stage), compiled.words);
  includes.files.insert(name);
  compiled.files.assign(includes.files.begin(), includes.files.end());
  return compiled;
}

namespace {

namespace fs = std::filesystem;

std::string file_of(const std::string& name) { return "passes/" + name; }

}  // namespace

Result<ShaderWatcher> ShaderWatcher::open(const std::string& folder, std::vector<std::string> names) {
  ShaderWatcher watch;
  watch.folder_ = folder;
  watch.names_ = std::move(names);
  std::error_code error;
  for (const std::string& name : watch.names_)
    if (!fs::is_regular_file(folder + "/" + file_of(name), error))
      return Error{folder + "/" + file_of(name) + ": not found; expected the program's folder of shaders, with all of them"};
  return watch;
}

std::map<std::string, ShaderWatcher::Timestamp> ShaderWatcher::read_timestamps() const {
  std::map<std::string, Timestamp> found;
  // a file that is being replaced may be missing for a moment; it is found at the next check
  for (const char* part : {"passes", "lib", "shared"}) {
    std::error_code error;
    for (fs::directory_iterator at(folder_ + "/" + part, error), end; !error && at != end; at.increment(error)) {
      std::error_code gone;
      const Timestamp stamp = at->last_write_time(gone);
      if (!gone) found[std::string(part) + "/" + at->path().filename().string()] = stamp;
    }
  }
  return found;
}

ShaderChanges ShaderWatcher::poll() {
  std::set<std::string> touched;
  for (const auto& [file, stamp] : read_timestamps()) {
    const auto [at, is_new] = timestamps_.try_emplace(file, stamp);
    if (!is_new && at->second == stamp) continue;
    at->second = stamp;
    touched.insert(file);
  }
  ShaderChanges news;
  if (touched.empty()) return news;
  for (const std::string& name : names_) {
    std::set<std::string>& files = files_[name];
    const bool concerns = files.empty() || std::ranges::any_of(touched, [&](const std::string& file) { return files.contains(file); });
    if (!concerns) continue;
    auto compiled = compile_shader(folder_, file_of(name));
    if (!compiled) {
      if (std::ranges::find(news.errors, compiled.error().message) == news.errors.end()) news.errors.push_back(compiled.error().message);
      continue;
    }
    files = {compiled->files.begin(), compiled->files.end()};
    news.changed.push_back({name, std::move(compiled->words)});
  }
  return news;
}

}  // namespace catena::render
