#include <gtest/gtest.h>

#include "../mutated.hpp"
#include "abaqus_deck.hpp"

namespace dovetail::solid_io {
namespace {

using Reader = std::function<SolidFile(std::string_view)>;

/// Reads; a file that is taken must give a valid mesh, anything else an InputError.
void expectMeshOrRefusal(const Reader& read, const std::string& text, std::size_t& taken, std::size_t& refused) {
  try {
    const SolidFile file = read(text);
    EXPECT_NO_THROW(fem::validate(file.mesh));
    ++taken;
  } catch (const InputError& error) {
    EXPECT_GT(std::string(error.what()).size(), 20u);
    ++refused;
  }
}

void fuzz(const Reader& read, const std::vector<std::string>& texts, int rounds) {
  std::mt19937 random(7);
  std::size_t taken = 0, refused = 0;
  for (const std::string& text : texts) {
    for (std::size_t end = 0; end < text.size(); end += 1 + text.size() / 200)
      expectMeshOrRefusal(read, text.substr(0, end), taken, refused);
    for (int round = 0; round < rounds; ++round) expectMeshOrRefusal(read, test::mutated(text, random), taken, refused);
  }
  EXPECT_GT(refused, 10 * texts.size());
  EXPECT_GT(taken, texts.size());
}

std::string garbage(std::mt19937& random, std::size_t length) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i)
    text += static_cast<char>(std::uniform_int_distribution<int>(0, 255)(random));
  return text;
}

TEST(MutatedFiles, GmshIsReadOrRefused) {
  std::vector<std::string> texts;
  for (const bool version4 : {false, true})
    for (const bool binary : {false, true}) texts.push_back(gmshTet(version4, binary));
  std::ostringstream box;
  writeGmsh(testMesh(fem::ElementShape::hex8), box);
  texts.push_back(box.str());
  fuzz([](std::string_view text) { return gmshFromText(text, "test.msh"); }, texts, 1500);
}

TEST(MutatedFiles, AbaqusIsReadOrRefused) {
  std::vector<std::string> texts;
  for (const fem::ElementShape shape : {fem::ElementShape::hex8, fem::ElementShape::tet10}) {
    std::ostringstream box;
    writeAbaqus(testMesh(shape), box);
    texts.push_back(box.str() +
                    "*NSET, NSET=a, GENERATE\n1, 9, 2\n*NSET, NSET=b\na, 3, a\n*SURFACE, TYPE=NODE, NAME=c\nb,\n");
  }
  texts.push_back(deckOf("*Nset, nset=Set-1, generate\n12, 1, -2\n*Elset, elset=Set-1\n1,\n",
                         "*Node\n1, 0.5, 0.5, 3.\n*Nset, nset=Set-1, instance=Part-1-1\n1, 2\n*Nset, nset=n, "
                         "elset=Part-1-1.Set-1\n*Nset, nset=m\nPart-1-1.4, n\n*Surface, name=s\nPart-1-1.1, S3\n"));
  fuzz([](std::string_view text) { return abaqusFromText(text, "test.inp"); }, texts, 1500);
}

TEST(MutatedFiles, GarbageIsRefused) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    const std::string text = garbage(random, 400);
    EXPECT_THROW(gmshFromText(text, "test.msh"), InputError);
    EXPECT_THROW(abaqusFromText(text, "test.inp"), InputError);
    for (const char* format : {"4.1 0 8\n", "4.1 1 8\n", "2.2 0 8\n", "2.2 1 8\n"}) {
      const std::string one("\1\0\0\0", 4);
      const std::string head =
          std::string("$MeshFormat\n") + format + (format[4] == '1' ? one : "") + "\n$EndMeshFormat\n";
      EXPECT_THROW(gmshFromText(head + "$Nodes\n" + text, "test.msh"), InputError);
      EXPECT_THROW(gmshFromText(head + "$Entities\n" + text, "test.msh"), InputError);
    }
    EXPECT_THROW(abaqusFromText("*NODE\n" + text, "test.inp"), InputError);
  }
}

}  // namespace
}  // namespace dovetail::solid_io
