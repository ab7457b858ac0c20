// The Python of the documents does what they say.
#include <gtest/gtest.h>

#include <cstdlib>

#include "../cantilever/program.hpp"

namespace dovetail::scene {
namespace {

using cantilever::test::runProgram;
using io::test::readText;
using io::test::ScratchFolder;
using io::test::writeText;

std::vector<std::string> snippets() {
  const std::string text = readText(std::filesystem::path(DOCS) / "outputs.md"), fence = "```python\n";
  std::vector<std::string> found;
  for (std::size_t at = text.find(fence); at != std::string::npos; at = text.find(fence, at + 1)) {
    const std::size_t begin = at + fence.size();
    found.push_back(text.substr(begin, text.find("```", begin) - begin));
  }
  return found;
}

/// The first Python that has both packages; Debian's belong to /usr/bin/python3, which need not be the first one found.
std::string pythonWithPackages() {
  for (const std::string python : {"python3", "/usr/bin/python3"})
    if (std::system((python + " -c 'import h5py, pandas' > /dev/null 2>&1").c_str()) == 0) return python;
  return "";
}

TEST(Snippets, OfTheDocumentsRun) {
  if (!WITH_HDF5) GTEST_SKIP() << "this build is without HDF5";
  const std::string python = pythonWithPackages();
  if (python.empty()) GTEST_SKIP() << "no python3 has h5py and pandas (Debian: python3-h5py, python3-pandas)";
  const ScratchFolder folder;
  ASSERT_EQ(runProgram({"run", std::string(SCENES) + "/plate.json", "--out", (folder / "out").string(), "--set",
                        "time=1e-4", "--set", "output={\"series\": 2e-5, \"hdf5\": true}"})
                .code,
            0);
  const std::vector<std::string> all = snippets();
  ASSERT_EQ(all.size(), 4U);
  const char* const said[] = {"J over", "dovetail ", "'do': 'run'", "UnstructuredGrid"};
  for (std::size_t k = 0; k < all.size(); ++k) {
    writeText(folder / "snippet.py", all[k]);
    const std::string command = "cd '" + (folder / "out").string() + "' && " + python + " ../snippet.py > ../said 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << readText(folder / "said");
    EXPECT_NE(readText(folder / "said").find(said[k]), std::string::npos) << readText(folder / "said");
  }
}

}  // namespace
}  // namespace dovetail::scene
