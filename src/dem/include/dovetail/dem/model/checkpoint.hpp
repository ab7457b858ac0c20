// Checkpoints of a model: a run continues from one to the last bit as if it had never stopped.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

/// The whole state as bytes: particles, periodicity, pairs with their memories, the laws' parts and parameters, every
/// term, the ledger. What is code is there by name only: a law of the caller's own, the function behind a moving wall,
/// an external force, a drive.
std::vector<char> saveState(const Model& m);
/// Reads such bytes into a model, see readCheckpoint. @param where  they come from, for errors
void loadState(const std::vector<char>& bytes, const std::string& where, Model& m);

/// Particles, pairs, space and clock of such bytes, whatever the laws: to be looked at, as a model without laws and
/// terms cannot go on. @throws InputError if the bytes are not of a model
Model contentOf(const std::vector<char>& bytes, const std::string& where);

/// Reads the grains alone from such bytes, into a model without any: particles and pairs with their memory, but no
/// terms and no ledger. The memory of wall contacts is not read.
/// @throws InputError if the laws or the periods are not those of the state, grains are members of bodies or bonded, or
/// have weights of an overlap; the model is then as it was
void loadGrains(const std::vector<char>& bytes, const std::string& where, Model& m);

/// State of a term in a checkpoint.
struct TermOfState {
  std::string name, code;
  std::vector<char> bytes;
};
struct PartsOfState {
  std::vector<std::int64_t> ids;  ///< of the particles
  std::vector<TermOfState> terms;
};
/// Of such bytes, in their order. @param m  a model with the laws of the state
PartsOfState partsOf(const std::vector<char>& bytes, const std::string& where, const Model& m);
/// Gives walls the contacts, with their springs, of walls of a state with the same shape and position. The model's
/// particles begin with those of the state, by their ids.
/// @return number of walls of which the state has none
int takeWallContacts(Model& m, const std::vector<TermOfState>& terms);

/// @throws InputError if the file cannot be written; what was there before is then still there
void writeCheckpoint(const std::filesystem::path& path, const Model& m);

/// Reads a state into a model. The model has the same terms as the one that was saved, in the same order, or none at
/// all: then those that are no code are made anew. Its laws are those that were saved, to the last bit. Domain,
/// booking, sorting and gravity come from the file.
/// @throws InputError if the file is foreign, cut off or changed, if laws or terms differ or code is missing, naming
/// it;
///         the model is then as it was
void readCheckpoint(const std::filesystem::path& path, Model& m);

}  // namespace dovetail::dem
