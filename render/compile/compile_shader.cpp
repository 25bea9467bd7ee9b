#include "render/compile/compile_shader.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <memory>
#include <optional>
#include <set>

#include "engine/base/text.h"

namespace catena::render {
namespace {

constexpr std::string_view kTop = "shaders/";
constexpr int kVersion = 460;

std::optional<std::string> text_of(const std::string& path) {
  auto text = read_text(path, "a shader");
  if (!text) return std::nullopt;
  return std::move(*text);
}

std::optional<EShLanguage> stage_of(std::string_view name) {
  if (name.ends_with(".vert")) return EShLangVertex;
  if (name.ends_with(".frag")) return EShLangFragment;
  if (name.ends_with(".comp")) return EShLangCompute;
  return std::nullopt;
}

/// Once a process; its end cleans up.
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

/// The first complaint of a log, "ERROR: place: what", without its first word.
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

}  // namespace catena::render
