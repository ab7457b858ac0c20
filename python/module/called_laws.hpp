// A contact law that is a function of Python's, called with all contacts of a sweep.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>

#include "arrays.hpp"
#include "contact_batch.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"

namespace dovetail::python {

/// As Python has them, whatever the order of their numbers.
using Values = py::array_t<double, py::array::forcecast>;

/// What the function is given: columns of a batch, as arrays that keep it.
struct ContactsView {
  std::shared_ptr<Batch> batch;
  int memory;                       ///< numbers that the law remembers
  const dem::Particles* particles;  ///< null once the law has answered

  py::array column(const py::object& self, std::size_t c) const;                         ///< (N)
  py::array matrix(const py::object& self, std::size_t first, std::size_t width) const;  ///< (N, width)
  py::array_t<std::int64_t> ids(const std::vector<int>& numbers) const;
  py::array_t<double> seen(const Values& slope) const;  ///< seenBy of all; slope (N) or one
  /// @throws InputError unless the shape is (N, numbers that are remembered)
  void remember(const Values& values) const;
};

/// A law is asked with the lock of the interpreter, once for all pairs and once for each wall and surface.
class CalledLaws final : public dem::ContactLaws {
public:
  /// @param function    contacts → force, or a dict of answers
  /// @param stiffness   contacts → three arrays (N): normal and tangential stiffness, N/m, and damping, N s/m
  /// @param parameters  what checkpoints compare, beside the name
  CalledLaws(std::string name, LawTraits law, py::function function, py::function stiffness,
             std::map<std::string, double> parameters);

  dem::ContactWork pairs(dem::Particles& particles, dem::PairList& list, double dt,
                         dem::Booking booking) const override;
  dem::ContactWork wall(dem::Particles& particles, dem::PrimitiveWall& wall, double dt,
                        dem::Booking booking) const override;
  dem::ContactWork wall(dem::Particles& particles, const dem::TriangulatedWall& wall, dem::WallContacts& contacts,
                        double dt, dem::Booking booking) const override;
  void addDemand(dem::ContactDemand& demand, const dem::Particles& particles, const dem::PairList& list,
                 double leastOverlap) const override;
  void addDemand(dem::ContactDemand& demand, const dem::Particles& particles,
                 const dem::PrimitiveWall& wall) const override;
  void addDemand(dem::ContactDemand& demand, const dem::Particles& particles, const dem::TriangulatedWall& wall,
                 const dem::WallContacts& contacts) const override;
  dem::ContactSample sample(const dem::Particles& particles, const dem::PairList& list) const override;
  double held(const dem::EndedPairs& pairs) const override { return energyOf(law_, pairs).lostPower(); }

  int memory() const override { return law_.kept(); }
  bool rotates() const override { return law_.rotates; }
  double reach() const override { return law_.reach; }
  int materials() const override { return 1; }
  const std::string& name() const override { return name_; }
  void saveParameters(ByteWriter& writer) const override;

  /// Whether it has answered without energies.
  bool lacksEnergies() const { return lacksEnergies_; }

private:
  void answer(const std::shared_ptr<Batch>& batch, const dem::Particles& particles) const;
  template <class AddDemand>
  void demandOf(const AddDemand& add, dem::ContactDemand& demand) const;

  std::string name_;
  LawTraits law_;
  std::shared_ptr<py::object> function_, stiffness_;
  std::map<std::string, double> parameters_;
  mutable std::atomic<bool> lacksEnergies_{false};
};

/// Puts what a law has answered into the batch. Returns whether energies are among it.
/// @throws InputError for answers of another name or shape, and numbers that are not finite, with their grains
bool takeAnswers(const py::object& answer, const ContactsView& contacts, const std::string& name);

void bindOwnLaws(py::module_& m);

}  // namespace dovetail::python
