#include "common/options.hpp"

#include <iostream>

#include "dovetail/core/error.hpp"

namespace dovetail::example {

Options readOptions(int argc, char** argv, const std::string& program, const std::string& about) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick") {
      options.quick = true;
    } else if (word == "--help") {
      options.help = true;
    } else if (word == "--out" && i + 1 < argc && argv[i + 1][0] != '\0') {
      options.out = argv[++i];
    } else {
      throw InputError(word == "--out" ? "--out lacks its folder" : "unknown option '" + word + "'", "",
                       "give --quick, --out DIR or --help");
    }
  }
  if (options.help)
    std::cout << about << "\nusage: " << program << " [--quick] [--out DIR]\n"
              << "  --quick    fewer or coarser runs, looser tolerance\n"
              << "  --out DIR  write CSV files (and VTU, if VTK is there) into DIR\n";
  return options;
}

int runExample(int argc, char** argv, const std::string& program, const std::string& about,
               const std::function<bool(const Options&)>& example) {
  try {
    const Options options = readOptions(argc, argv, program, about);
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
