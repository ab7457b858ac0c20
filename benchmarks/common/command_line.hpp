// Command lines of the benchmark programs: options that name a choice, and refusals in one line.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>

namespace dovetail::benchmark {

/// An option whose value is one of the names; `use` gets what stands behind it. The help lists the names.
template <class Value>
CLI::Option* addChoice(CLI::App& app, const std::string& name, const std::map<std::string, Value>& names,
                       const std::function<void(Value)>& use, const std::string& help) {
  std::string list;
  for (const auto& [key, value] : names) list += (list.empty() ? "" : "|") + key;
  // Not CLI::CheckedTransformer, which would also take the numbers behind the names.
  return app
      .add_option_function<std::string>(
          name, [use, names](const std::string& key) { use(names.at(key)); }, help)
      ->check(CLI::IsMember(names).description(""))
      ->option_text(list);
}

/// The same, into a variable that outlives the parsing.
template <class Value>
CLI::Option* addChoice(CLI::App& app, const std::string& name, Value& target, const std::map<std::string, Value>& names,
                       const std::string& help) {
  return addChoice<Value>(
      app, name, names, [&target](Value value) { target = value; }, help);
}

/// Refuses what is written on the command line but would do nothing. @param when that which makes it so, such as
/// "--full-dem"; `remedy`: what to do instead
/// @throws InputError naming the first of the options that was given
void refuseIdle(const CLI::App& app, std::initializer_list<const char*> options, const std::string& when,
                const std::string& remedy);

/// Parses; prints the help to standard output and returns false for --help.
/// @throws InputError in one line for unknown options, values that cannot be read, and empty ones
bool parseCommandLine(CLI::App& app, int argc, char** argv);

}  // namespace dovetail::benchmark
