#include "common/options.hpp"

#include <iostream>

#include "dovetail/core/error.hpp"

namespace dovetail::example {

Options readOptions(int argc, char** argv, const std::string& program, const std::string& about, Files files) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick") {
      options.quick = true;
    } else if (word == "--help") {
      options.help = true;
    } else if (word == "--out" && files == Files::some && i + 1 < argc && argv[i + 1][0] != '\0') {
      options.out = argv[++i];
    } else {
      const bool lacks = word == "--out" && files == Files::some;
      throw InputError(lacks ? "--out lacks its folder" : "unknown option '" + word + "'", "",
                       files == Files::some ? "give --quick, --out DIR or --help" : "give --quick or --help");
    }
  }
  if (options.help) {
    std::cout << about << "\nusage: " << program << (files == Files::some ? " [--quick] [--out DIR]\n" : " [--quick]\n")
              << "  --quick    fewer or coarser runs, looser tolerance\n";
    if (files == Files::some) std::cout << "  --out DIR  write CSV files (and VTU, if VTK is there) into DIR\n";
  }
  return options;
}

int runExample(int argc, char** argv, const std::string& program, const std::string& about,
               const std::function<bool(const Options&)>& example, Files files) {
  try {
    const Options options = readOptions(argc, argv, program, about, files);
    if (options.help) return 0;
    return example(options) ? 0 : 1;
  } catch (const InputError& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace dovetail::example
