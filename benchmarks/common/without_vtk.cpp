#include "common/outputs.hpp"

std::unique_ptr<dovetail::benchmark::FrameWriter> dovetail::benchmark::makeFrameWriter(const std::filesystem::path&,
                                                                                       const std::string&,
                                                                                       const io::KeyValues&) {
  return nullptr;
}
