// Variables of files of netCDF's classic formats (CDF-1, CDF-2, CDF-5), see the format's specification by Unidata.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dovetail::solid_io {

class NetcdfFile {
public:
  /// @param bytes  of the file; they must outlive this
  /// @throws InputError naming the byte, if the header is not whole or of another kind
  NetcdfFile(std::string_view bytes, std::string name);

  /// Length of a dimension; 0 if it is not there.
  std::size_t dimension(const std::string& name) const;
  bool has(const std::string& variable) const { return variables_.contains(variable); }
  /// Lengths of a variable's dimensions, the slowest first; none if it is not there.
  std::vector<std::size_t> shape(const std::string& variable) const;
  /// All values, the last dimension fastest. @throws InputError if the variable is not there, of another kind or beyond
  /// the end of the file
  std::vector<std::int64_t> integers(const std::string& variable) const;
  std::vector<double> reals(const std::string& variable) const;
  /// Rows of characters, without zeros and blanks at their ends; none if it is not there.
  std::vector<std::string> texts(const std::string& variable) const;
  /// An attribute of characters; empty if it is not there.
  std::string attribute(const std::string& variable, const std::string& name) const;
  const std::string& name() const { return name_; }

private:
  struct Variable {
    std::vector<std::size_t> shape;
    std::map<std::string, std::string> attributes;
    std::uint32_t type = 0;
    std::uint64_t begin = 0;
    bool ofRecords = false;
  };
  class Header;

  const Variable& need(const std::string& variable) const;
  std::string_view bytesOf(const Variable& variable, const std::string& name, std::size_t& count) const;

  std::string_view bytes_;
  std::string name_;
  std::map<std::string, std::size_t> dimensions_;
  std::map<std::string, Variable> variables_;
};

}  // namespace dovetail::solid_io
