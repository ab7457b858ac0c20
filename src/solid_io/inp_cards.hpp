// Cards of an INP file: a line with a star, a keyword and parameters, and data lines up to the next.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dovetail/io/text_source.hpp"

namespace dovetail::solid_io {

using io::lower, io::shown, io::TextSource, io::trimmed;

/// A parameter that a card may have.
struct Parameter {
  std::string_view name;
  enum { value, flag } kind = value;
};

class InpCards {
public:
  explicit InpCards(TextSource& source) : source_(source) {}

  /// What the file begins with before its first card, shown; empty if there is nothing.
  /// @throws InputError for what could be a card or its data
  std::string textBeforeCards();
  /// Goes to the next card; false at the end of the file.
  bool next();
  /// The keyword in lower case, without blanks: "node".
  const std::string& keyword() const { return keyword_; }
  std::size_t place() const { return place_; }
  /// Value of a parameter without its quotes, null if it is not given; names are compared without regard to case.
  const std::string* parameter(const std::string& name) const;
  bool has(const std::string& name) const { return parameter(name) != nullptr; }
  /// @throws InputError if it is not given or empty
  const std::string& required(const std::string& name) const;

  /// @throws InputError for a parameter of this card that is not one of these, is given twice, or runs into the next
  /// one
  void requireKnown(const std::vector<Parameter>& known) const;
  /// @throws InputError if the card has data lines
  void requireNoData();
  /// Where the data lines of this card begin.
  std::size_t end() const { return hasPeeked_ ? peekPlace_ : source_.offset(); }

  /// The fields of the next data line of this card; false at its end.
  bool data(std::vector<std::string_view>& fields);
  std::size_t dataPlace() const { return dataPlace_; }
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const;
  [[noreturn]] void refuseData(const std::string& problem, const std::string& remedy) const;

private:
  /// The next line that is no comment and not empty; false at the end.
  bool peek(std::string_view& line);
  void readCardLine(std::string_view line);
  void requireComma(std::string_view card) const;
  void requireWhole(const std::string& name, const std::string& value, bool quoted) const;

  TextSource& source_;
  std::string keyword_;
  struct Given {
    std::string name, value;
    bool quoted;
  };
  std::vector<Given> parameters_;
  std::size_t place_ = 0, dataPlace_ = 0, peekPlace_ = 0;
  std::string_view peeked_;
  bool hasPeeked_ = false;
};

}  // namespace dovetail::solid_io
