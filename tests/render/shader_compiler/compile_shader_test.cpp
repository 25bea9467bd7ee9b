// SPDX-License-Identifier: MIT
/// Shaders compiled at run time, and their file watch.
#include "render/shader_compiler/compile_shader.h"

#include <algorithm>
#include <filesystem>

#include "render/passes/pass.h"
#include "tests/render/support/image_fixture.h"
#include "tests/support/support.h"

namespace catena::test::compile_shader_test {

namespace fs = std::filesystem;
using namespace catena::render;

constexpr const char* kGreen = R"(#version 460
layout(location = 0) out vec4 out_color;
void main() { out_color = vec4(0.0, 1.0, 0.0, 1.0); }
)";

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const EmbeddedShader& shader : embedded_shaders()) all.emplace_back(shader.name);
  return all;
}

/// A modifiable copy of shaders/.
class Shaders : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = temporary_ / "shaders";
    fs::copy(test::source_dir() + "/shaders", folder_, fs::copy_options::recursive);
  }
  void write(const std::string& file, const std::string& text) {
    const auto before = fs::exists(folder_ + "/" + file) ? fs::last_write_time(folder_ + "/" + file) : fs::file_time_type::clock::now();
    write_file(folder_ + "/" + file, text);
    fs::last_write_time(folder_ + "/" + file, before + std::chrono::seconds(1));
  }
  TemporaryFolder temporary_;
  std::string folder_;
};

TEST_F(Shaders, CompileToTheSpirvOfTheBuild) {
  ASSERT_GE(embedded_shaders().size(), 20u);
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const auto compiled = compile_shader(folder_, "passes/" + std::string(shader.name));
    ASSERT_TRUE(compiled) << compiled.error().message;
    EXPECT_TRUE(std::ranges::equal(compiled->words, shader.words)) << shader.name;
  }
}

TEST_F(Shaders, ErrorsNameFileAndLine) {
  write("passes/compose.frag", "#version 460\n\nvoid main() { nonsense; }\n");
  const auto compiled = compile_shader(folder_, "passes/compose.frag");
  ASSERT_FALSE(compiled);
  const std::string& text = compiled.error().message;
  EXPECT_EQ(text.find(folder_ + "/passes/compose.frag:3: "), 0u) << text;
  EXPECT_NE(text.find("nonsense"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  EXPECT_FALSE(compile_shader(folder_, "passes/none.frag"));
  EXPECT_FALSE(compile_shader(folder_, "lib/rays.glsl"));

  // an error in an included file has that file's name and line
  write("lib/rays.glsl", "\n\nbad bad bad\n" + read_file(folder_ + "/lib/rays.glsl"));
  const auto volume = compile_shader(folder_, "passes/volume.frag");
  ASSERT_FALSE(volume);
  EXPECT_EQ(volume.error().message.find(folder_ + "/lib/rays.glsl:3: "), 0u) << volume.error().message;
}

TEST_F(Shaders, AWatchRecompilesChangedFilesAndTheirIncluders) {
  EXPECT_FALSE(ShaderWatcher::open(temporary_ / "nowhere", names()));
  auto watch = ShaderWatcher::open(folder_, {"compose.frag", "volume.frag", "mesh.vert"});
  ASSERT_TRUE(watch);
  EXPECT_EQ(watch->poll().changed.size(), 3u);
  EXPECT_TRUE(watch->poll().changed.empty());

  write("passes/compose.frag", kGreen);
  ShaderChanges news = watch->poll();
  ASSERT_EQ(news.changed.size(), 1u);
  EXPECT_EQ(news.changed[0].name, "compose.frag");
  EXPECT_TRUE(news.errors.empty());

  write("lib/rays.glsl", read_file(folder_ + "/lib/rays.glsl") + "\n");
  news = watch->poll();
  ASSERT_EQ(news.changed.size(), 1u);
  EXPECT_EQ(news.changed[0].name, "volume.frag");

  write("passes/compose.frag", "nothing");
  news = watch->poll();
  EXPECT_TRUE(news.changed.empty());
  EXPECT_EQ(news.errors.size(), 1u);
  EXPECT_TRUE(watch->poll().errors.empty()) << "said once";
}

class ReloadTest : public ImageTest {
 protected:
  FramePacket packet() {
    FramePacket p = make_packet({0, -60, 0}, {7.5, 7.5, 7.5});
    p.background = {0.2f, 0.1f, 0.4f, 1};
    p.volumes.push_back(volume_item(make_grid({16, 16, 16}, [](const Vec3& q) { return q.x / 15; }), {{0, 0.1}, {1, 0.1}}, {1, 0, 0}));
    return p;
  }
  Result<bool> replace(const std::string& name, const std::string& text) {
    TemporaryFolder folder;
    fs::create_directories(folder / "passes");
    write_file(folder / ("passes/" + name), text);
    CATENA_TRY(auto compiled, compile_shader(folder.path(), "passes/" + name));
    return renderer_->replace_shader(name, std::move(compiled.words));
  }
};

TEST_F(ReloadTest, AReplacedShaderDrawsTheNextImageAndCanBeReverted) {
  const FramePacket scene = packet();
  const Image8 before = draw(scene, {}, "before");
  const auto compiled = replace("compose.frag", kGreen);
  ASSERT_TRUE(compiled) << compiled.error().message;
  EXPECT_TRUE(*compiled);
  EXPECT_FALSE(*replace("compose.frag", kGreen)) << "it is there already";
  const Image8 green = draw(scene, {}, "green");
  for (std::size_t i = 0; i < green.rgba.size(); i += 4)
    ASSERT_TRUE(green.rgba[i] == 0 && green.rgba[i + 1] == 255 && green.rgba[i + 2] == 0) << i;

  // shaders with errors, missing shaders and unknown bindings change nothing
  EXPECT_FALSE(replace("compose.frag", "#version 460\nvoid main() { nonsense; }\n"));
  EXPECT_FALSE(replace("none.frag", kGreen));
  const auto bound = replace("compose.frag", R"(#version 460
layout(binding = 9) uniform U { vec4 color; } u;
layout(location = 0) out vec4 out_color;
void main() { out_color = u.color; }
)");
  ASSERT_FALSE(bound);
  EXPECT_NE(bound.error().message.find("binding 9"), std::string::npos) << bound.error().message;
  EXPECT_EQ(max_difference(draw(scene), green), 0);

  renderer_->restore_shaders();
  EXPECT_EQ(max_difference(draw(scene), before), 0);
  EXPECT_GT(max_difference(before, green), 100);
}

}  // namespace catena::test::compile_shader_test
