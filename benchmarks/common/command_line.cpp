#include "common/command_line.hpp"

#include <algorithm>
#include <iostream>

#include "dovetail/core/error.hpp"

namespace dovetail::benchmark {

namespace {

void refuseEmptyValues(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results())
      if (value.empty())
        throw InputError("the value is empty", option->get_name(), "give one, or leave the option out");
}

}  // namespace

void refuseIdle(const CLI::App& app, std::initializer_list<const char*> options, const std::string& when,
                const std::string& remedy) {
  for (const char* option : options)
    if (app.get_option(option)->count() > 0) throw InputError("the option does nothing " + when, option, remedy);
}

bool parseCommandLine(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  } catch (const CLI::ParseError& error) {
    std::string text = error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    throw InputError(text, "command line", "see " + app.get_name() + " --help for the options and their values");
  }
  refuseEmptyValues(app);
  return true;
}

}  // namespace dovetail::benchmark
