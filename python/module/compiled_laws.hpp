// Contact laws out of libraries that users compile.
#pragma once

#include <filesystem>

#include "dovetail/dem/laws/law_library.hpp"

namespace dovetail::python {

/// Opens a library and takes its laws, whose code stays for as long as the process lives.
/// @throws InputError for files that are no library of laws, or of other headers
dem::LawLibrary openLaws(const std::filesystem::path& file);

/// Under the name that its library gives it.
/// @throws InputError as the law does
std::shared_ptr<const dem::ContactLaws> makeCompiled(const std::string& name, const dem::CompiledLaw& law,
                                                     const dem::LawParameters& parameters);

}  // namespace dovetail::python
