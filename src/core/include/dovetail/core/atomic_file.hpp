// Files that are complete or not there, and that never take the place of anybody else's.
#pragma once

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>

namespace dovetail {

/// Whether something at a path was written by a program of ours, which may then replace or remove it.
using IsOurs = bool (*)(const std::filesystem::path& path);

/// Whether this process does: of a team() the first rank, for all of them. Nothing below writes, removes or looks for
/// what is in the way elsewhere.
bool writesFiles();

/// A regular file, opened to be read; a stream that has failed for anything else, whose opening or reading may never
/// end (pipes, devices) or makes no sense (folders).
std::ifstream openFile(const std::filesystem::path& path, std::ios::openmode mode = std::ios::in);

/// The first `size` bytes of a regular file, fewer if it is shorter; empty for anything else. Links are not followed.
std::string headOf(const std::filesystem::path& path, std::size_t size);

/// @throws InputError if something that is not ours is at `path`
void requireFreeOrOurs(const std::filesystem::path& path, IsOurs isOurs);

/// Proves that files can be written in `folder`, by writing one and removing it. @throws InputError if not
void requireWritable(const std::filesystem::path& folder);

/// What a file has to survive. Bytes that have to survive a power cut are forced onto the disk, which takes
/// milliseconds; a program that is killed leaves whole files either way.
enum class Survives { powerCuts, kills };

/// Writes the pieces one behind the other to a new file "<path>.part-<process>-<number>", forces them onto the disk if
/// that is asked for, and renames the file, so that a reader, a crash or a power cut finds the old bytes or the new
/// ones.
/// @throws InputError if nothing can be written there, or if `path` is taken by something that is not ours: the new
///         file then stays under its temporary name, which the error gives
/// @throws Error if writing breaks off (disk full); what was there is intact, and nothing is left
void replaceFile(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces, IsOurs isOurs,
                 Survives survives = Survives::powerCuts);

/// Appends to a file of ours. A killed program may leave a part of the bytes.
/// @throws InputError if there is none that can be written; Error if writing breaks off: the file is as it was
void appendToFile(const std::filesystem::path& path, std::string_view bytes, IsOurs isOurs);

/// Removes from `folder` (not from folders in it) the temporary files of ours that killed programs left, those too into
/// which nothing had been written yet.
void removeLeftovers(const std::filesystem::path& folder, IsOurs isOurs);

}  // namespace dovetail
