// Files of a run: checked before the run, replaced as a whole, and never at the cost of anybody else's files.
//
// The rule. A file is ours if it is a regular file that begins with the mark "dovetail <version>" as one of our writers
// puts it: behind the sign of a comment, as the first entry of a JSON object, in an attribute (HDF5) or text (PNG). Our
// name elsewhere in a file does not count. A file of ours with the same name and of the same kind, from an earlier run,
// is replaced in one rename when the new one is complete. Everything else in a folder is left as it is: no function
// here deletes or overwrites a file without the mark, and none follows a symbolic link to replace what it points to.
//
// A program that is killed while it writes leaves a file "<name>.part-<process>-<number>"; the next run that prepares
// the folder removes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/core/atomic_file.hpp"

namespace dovetail::io {

/// Makes `folder` (with its parents) if it is not there, proves before a long run that a file can be written, by
/// writing one and removing it, and removes what killed runs left under temporary names, also in the folders in it.
/// `fileNames` are the names the run will write in it: they must be free or ours.
/// @return the folder
/// @throws InputError if the path is empty or a file, if nothing can be written there, or if a name is taken
std::filesystem::path prepareOutputFolder(const std::filesystem::path& folder,
                                          const std::vector<std::string>& fileNames = {});

/// The same for a folder of a run's own in its folder. @throws InputError also if it is a symbolic link, which could
/// lead out of it
std::filesystem::path prepareInnerFolder(const std::filesystem::path& folder,
                                         const std::vector<std::string>& fileNames = {});

/// Removes frames of ours, "<name>_<number>.vtu" or ".vtp", of an earlier run from a folder, and the folder if nothing
/// is left in it.
void removeFrames(const std::filesystem::path& folder, const std::string& name);

/// Writes `text` under a temporary name beside `path` and renames it; see Survives for files that come often. The text
/// should carry the mark (see above), or a later run will not replace it.
/// @throws InputError if nothing can be written there, if a file of ours of another kind is there, or if `path` is
/// taken
///         by something that is not ours: the text then stays under its temporary name, which the error gives
/// @throws Error if writing breaks off (disk full); what was there is intact
void writeFileAtomically(const std::filesystem::path& path, const std::string& text,
                         Survives survives = Survives::powerCuts);

/// True if `path` is a file of an earlier run of ours, by the rule above.
bool isOurs(const std::filesystem::path& path);

/// @throws InputError if something that is not ours is at `path`
void requireFreeOrOurs(const std::filesystem::path& path);

/// Removes a file of an earlier run of ours, so that it is not left beside the results of a new one.
/// @throws InputError if something that is not ours is at `path`; Error if it cannot be removed
void removeOurs(const std::filesystem::path& path);

/// Removes the pages and the picture of a report of ours, and of figures those that it names.
void removeReport(const std::filesystem::path& folder);

/// @throws InputError if there are files of an earlier run of ours in a folder, finished or not
void requireNoRun(const std::filesystem::path& folder);

/// Takes back a folder that prepareOutputFolder has made, with those above it that it made, as far as they are empty,
/// once a lock holds it and unless it is told to keep them: for runs that may be refused before they write.
class FolderOnTrial {
public:
  /// Before the folder is made.
  explicit FolderOnTrial(const std::filesystem::path& folder);
  ~FolderOnTrial();
  FolderOnTrial(const FolderOnTrial&) = delete;
  FolderOnTrial& operator=(const FolderOnTrial&) = delete;
  void keep() { held_ = false; }

private:
  friend class FolderLock;
  std::vector<std::filesystem::path> missing_;  ///< the innermost first
  bool held_ = false;                           ///< by a lock: no other run that has made it at the same time uses it
};

/// Holds a folder for one run while it lives; the system lets go of it when the process ends, however it ends. Where
/// the file system knows no locks, it holds nothing.
class FolderLock {
public:
  /// @throws InputError if another run holds the folder
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const std::filesystem::path& folder, FolderOnTrial& trial) : FolderLock(folder) { trial.held_ = true; }
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

private:
  int descriptor_;
};

}  // namespace dovetail::io
