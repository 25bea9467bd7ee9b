#include "engine/scene/document.h"

#include <gtest/gtest.h>

#include "engine/scene/write_values.h"
#include "tests/support/support.h"

namespace catena::scene {
namespace {

TEST(Document, Smoke) {
  const test::TemporaryFolder folder;
  const std::string text = "// mine\n{\n  \"fields\": {\"s\": {\"analytic\": \"sphere\"}},\n  \"isosurfaces\": [{\"field\": \"s\", \"level\": 1}] // end\n}\n";
  test::write_file(folder / "a.json", text);
  auto document = Document::open(folder / "a.json");
  ASSERT_TRUE(document) << document.error().message;
  ASSERT_TRUE(document->set("/isosurfaces/0/level", "0.5", "level", "d"));
  ASSERT_TRUE(document->set("/isosurfaces/0/level", "0.75", "level", "d"));
  ASSERT_TRUE(document->set("/volumes/-", "{\"field\": \"s\"}", "volume"));
  std::puts(document->text().c_str());
  document->undo();
  document->undo();
  EXPECT_EQ(document->text(), text);
}

}  // namespace
}  // namespace catena::scene
