// SPDX-License-Identifier: MIT
/// The site of documents and public headers: Doxygen (warnings are errors) finds a description of every public name, and every link of
/// every page leads to a file.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace site_test {

namespace fs = std::filesystem;
namespace test = catena::test;

/// Local files that a page links to or embeds, without anchors and external links.
std::set<std::string> links_of(std::string_view page) {
  std::set<std::string> links;
  for (const std::string_view mark : {"href=\"", "src=\""})
    for (std::size_t at = page.find(mark); at != page.npos; at = page.find(mark, at + 1)) {
      const std::size_t begin = at + mark.size(), end = page.find('"', begin);
      std::string link(page.substr(begin, end - begin));
      link = link.substr(0, link.find('#'));
      if (!link.empty() && !link.starts_with("http") && !link.starts_with("javascript:")) links.insert(link);
    }
  return links;
}

TEST(Site, EveryNameIsDocumentedAndEveryLinkIsValid) {
  if (std::string(CATENA_DOXYGEN).empty()) GTEST_SKIP() << "doxygen is missing (apt-get install doxygen): the site is not made";
  const std::string site = test::binary_dir() + "/site";
  fs::remove_all(site);
  const test::ProgramResult made = test::run_program(CATENA_CMAKE, {"-P", test::binary_dir() + "/site.cmake"});
  ASSERT_EQ(made.exit_code, 0) << made.out << made.err;

  // the site contains the public headers and the pages
  EXPECT_TRUE(test::exists(site + "/classcatena_1_1haptics_1_1Constraint.html"));
  EXPECT_TRUE(test::exists(site + "/page-user-tutorials-first-force.html"));
  int pages = 0;
  std::set<std::string> known;
  for (const auto& entry : fs::directory_iterator(site)) {
    if (entry.path().extension() != ".html") continue;
    ++pages;
    for (const std::string& link : links_of(test::read_file(entry.path().string())))
      if (!known.contains(link)) {
        EXPECT_TRUE(fs::exists(site + "/" + link)) << entry.path().filename() << " links to " << link;
        known.insert(link);
      }
  }
  EXPECT_GT(pages, 300);
}

}  // namespace site_test
