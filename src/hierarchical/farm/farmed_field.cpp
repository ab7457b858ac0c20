#include "farmed_field.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <numeric>
#include <random>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/failure.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "farm_plan.hpp"
#include "samples.hpp"
#include "share.hpp"

namespace dovetail::hierarchical {

namespace {

/// Points whose states travel together, and that are shown together.
constexpr std::size_t block = 64;
double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// @throws what has gone wrong there
void requireDone(int rank, ByteReader& reply) {
  Failure failure{};
  reply(failure);
  if (failure == Failure::none) return;
  std::string text;
  reply(text);
  raise(failure, text, "rank " + std::to_string(rank));
}

/// Letters that nobody has read would be taken for answers to later ones.
class Exchange {
public:
  explicit Exchange(Mail& mail) : mail_(mail) {}
  ~Exchange() {
    if (!done_) mail_.giveUp();
  }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;
  void done() { done_ = true; }

private:
  Mail& mail_;
  bool done_ = false;
};

class FarmedField final : public fem::PointField {
public:
  FarmedField(const CellRecipe& recipe, Deal deal, Mail& mail, FarmMoving moving)
      : recipe_(recipe),
        name_(nameOf(*recipe.samples)),
        density_(meanDensity(*recipe.samples)),
        deal_(std::move(deal)),
        mail_(mail),
        moving_(moving),
        own_(recipe) {
    static std::atomic<std::uint64_t> fields{0};
    field_ = fields++;
  }
  ~FarmedField() override {
    if (numbers_.empty()) return;
    try {
      tellAll(Verb::close);
      mail_.settle();
    } catch (...) {  // the workers are gone
    }
  }

  std::string name() const override { return name_; }
  double density() const override { return density_; }

  void open(std::span<const fem::PointPlace> places) override {
    sample_.clear();
    for (const fem::PointPlace& place : places) sample_.push_back(deal_(place));
    const auto ranks = static_cast<std::size_t>(mail_.ranks());
    forgetSeen();
    answered_ = false;
    own_.clear();
    numbers_.assign(ranks, {});
    owner_.resize(places.size());
    seconds_.assign(places.size(), 0.0);
    stepSeconds_ = seconds_;
    threads_.assign(ranks, threads());
    report_ = {std::vector<std::size_t>(ranks), std::vector<double>(ranks), 0, 0, 0.0};
    ByteWriter recipe;
    write(recipe_, recipe);
    for (int rank = 1; rank < mail_.ranks(); ++rank) {
      ByteWriter letter = begin(Verb::open);
      letter.append(recipe.bytes());
      mail_.send(rank, letter.take());
    }
    for (std::size_t p = 0; p < places.size(); ++p) owner_[p] = static_cast<int>(p % ranks);
    handOut([](std::uint64_t) { return std::vector<char>{}; });
  }

  void evaluate(const fem::FieldRequest& request) override {
    if (answered_ && !request.moved && request.tangent.empty() && !request.withEnergy) return;
    forgetSeen();
    Exchange exchange(mail_);
    for (int rank = 1; rank < mail_.ranks(); ++rank) {
      ByteWriter letter = begin(Verb::evaluate);
      letter(questionFor(rank, request));
      mail_.send(rank, letter.take());
    }
    mail_.settle();
    std::exception_ptr failure;  // the others' answers are on their way all the same
    try {
      hand(0, own_.evaluate(questionFor(0, request)), request);
    } catch (...) {
      failure = std::current_exception();
    }
    const double start = now();
    gather(exchange, [&](int rank, ByteReader& reply) {
      Answers answers;
      reply(answers);
      hand(rank, answers, request);
    });
    if (failure) std::rethrow_exception(failure);
    answered_ = true;
    report_.waited += now() - start;
    ++report_.evaluations;
  }

  void commit() override {
    forgetSeen();
    answered_ = false;
    tellAll(Verb::commit);
    own_.commit();
    if (moving_ == FarmMoving::atRandom)
      moveAtRandom();
    else
      moveWhereItPays();
    std::ranges::fill(stepSeconds_, 0.0);
  }
  void revert() override {
    answered_ = false;
    tellAll(Verb::revert);
    own_.revert();
  }

  void save(ByteWriter& archive) const override {
    archive(static_cast<std::uint64_t>(owner_.size()));
    for (std::size_t first = 0; first < owner_.size(); first += block)
      for (const std::vector<char>& state : statesOf(blockAt(first), Verb::copy)) archive.append(state);
  }
  void load(ByteReader& archive) override {
    fem::readPointCount(archive, owner_.size(), name());
    std::vector<std::vector<char>> states;
    for (const std::uint64_t sample : sample_) {
      const std::size_t begin = archive.position();
      own_.fresh(sample)->load(archive);  // tells where it ends, and whether it is one
      const std::span<const char> state = archive.since(begin);
      states.emplace_back(state.begin(), state.end());
    }
    forgetSeen();
    answered_ = false;
    tellAll(Verb::clear);
    own_.clear();
    for (std::vector<std::uint64_t>& numbers : numbers_) numbers.clear();
    std::ranges::fill(report_.points, std::size_t{0});
    handOut([&](std::uint64_t number) { return std::move(states[number]); });
  }

  const fem::FieldPoint* point(std::size_t p) const override {
    if (owner_.at(p) == 0) return &own_.point(p);
    const std::size_t first = p / block * block;
    if (seen_.empty() || firstSeen_ != first) {
      const std::vector<std::uint64_t> numbers = blockAt(first);
      std::vector<std::vector<char>> states = statesOf(numbers, Verb::copy);
      std::vector<std::unique_ptr<fem::FieldPoint>> seen;
      for (std::size_t k = 0; k < numbers.size(); ++k)
        seen.push_back(own_.unpack({numbers[k], sample_[numbers[k]], std::move(states[k])}));
      seen_ = std::move(seen);
      firstSeen_ = first;
    }
    return seen_[p - first].get();
  }

  int copies(std::size_t p) const {
    if (copies_.empty()) {
      std::vector<int> all(owner_.size());
      const auto take = [&](std::size_t rank, const std::vector<int>& copies) {
        for (std::size_t k = 0; k < copies.size(); ++k) all[numbers_[rank].at(k)] = copies[k];
      };
      Exchange exchange(mail_);
      tellAll(Verb::count);
      gather(exchange, [&](int rank, ByteReader& reply) {
        std::vector<int> copies;
        reply(copies);
        take(static_cast<std::size_t>(rank), copies);
      });
      take(0, own_.copies());
      copies_ = std::move(all);
    }
    return copies_.at(p);
  }

  std::vector<double> seconds() const override { return seconds_; }
  const FarmReport& report() const { return report_; }

private:
  ByteWriter begin(Verb verb) const {
    ByteWriter letter;
    letter(verb, field_);
    return letter;
  }
  void tellAll(Verb verb) const {
    for (int rank = 1; rank < mail_.ranks(); ++rank) mail_.send(rank, begin(verb).take());
  }
  std::vector<std::uint64_t> blockAt(std::size_t first) const {
    std::vector<std::uint64_t> numbers(std::min(block, owner_.size() - first));
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
  }

  void forgetSeen() {
    seen_.clear();
    copies_.clear();
  }

  /// Takes a reply of every worker, in whatever order they come. @throws what went wrong at the lowest rank
  template <class Take>
  void gather(Exchange& exchange, Take&& take) const {
    std::vector<std::vector<char>> replies(static_cast<std::size_t>(mail_.ranks()));
    for (int k = 1; k < mail_.ranks(); ++k) {
      Letter letter = mail_.receive();
      replies[static_cast<std::size_t>(letter.from)] = std::move(letter.bytes);
    }
    exchange.done();
    for (int rank = 1; rank < mail_.ranks(); ++rank) {
      ByteReader reply(std::move(replies[static_cast<std::size_t>(rank)]));
      requireDone(rank, reply);
      take(rank, reply);
    }
  }

  /// Points to their owners, who have none.
  template <class StateOf>
  void handOut(StateOf&& stateOf) {
    for (std::size_t first = 0; first < owner_.size(); first += block) {
      std::vector<std::vector<Parcel>> parcels(numbers_.size());
      for (const std::uint64_t p : blockAt(first))
        parcels[static_cast<std::size_t>(owner_[p])].push_back({p, sample_[p], stateOf(p)});
      for (std::size_t rank = 0; rank < parcels.size(); ++rank) deliver(static_cast<int>(rank), parcels[rank]);
      mail_.settle();
    }
  }
  void deliver(int rank, const std::vector<Parcel>& parcels) {
    if (parcels.empty()) return;
    for (const Parcel& parcel : parcels) {
      owner_[parcel.number] = rank;
      numbers_[static_cast<std::size_t>(rank)].push_back(parcel.number);
      ++report_.points[static_cast<std::size_t>(rank)];
      if (rank == 0) own_.take(parcel);
    }
    if (rank == 0) return;
    ByteWriter letter = begin(Verb::take);
    letter(parcels);
    mail_.send(rank, letter.take());
  }

  /// Committed states of points, in the order of the numbers.
  std::vector<std::vector<char>> statesOf(const std::vector<std::uint64_t>& numbers, Verb verb) const {
    std::vector<std::vector<std::size_t>> asked(numbers_.size());
    for (std::size_t k = 0; k < numbers.size(); ++k) asked[static_cast<std::size_t>(owner_[numbers[k]])].push_back(k);
    Exchange exchange(mail_);
    for (int rank = 1; rank < mail_.ranks(); ++rank) {
      std::vector<std::uint64_t> theirs;
      for (const std::size_t k : asked[static_cast<std::size_t>(rank)]) theirs.push_back(numbers[k]);
      ByteWriter letter = begin(verb);
      letter(theirs);
      mail_.send(rank, letter.take());
    }
    mail_.settle();
    std::vector<std::vector<char>> states(numbers.size());
    gather(exchange, [&](int rank, ByteReader& reply) {
      for (const std::size_t k : asked[static_cast<std::size_t>(rank)]) reply(states[k]);
    });
    for (const std::size_t k : asked[0]) states[k] = own_.stateOf(numbers[k]);
    if (!states.empty()) bytesOfState_ = states.front().size();
    return states;
  }

  Question questionFor(int rank, const fem::FieldRequest& request) const {
    Question question{
        request.dt, isNew(request), request.rateAtEnd, request.willCommit, request.withEnergy, !request.tangent.empty(),
        {}};
    for (const std::uint64_t p : numbers_[static_cast<std::size_t>(rank)])
      question.F.insert(question.F.end(), request.F.begin() + static_cast<std::ptrdiff_t>(9 * p),
                        request.F.begin() + static_cast<std::ptrdiff_t>(9 * p + 9));
    return question;
  }
  /// Points that were committed, reverted or loaded answer anew, whatever is asked.
  bool isNew(const fem::FieldRequest& request) const { return request.moved || !answered_; }
  void hand(int rank, const Answers& answers, const fem::FieldRequest& request) {
    const std::vector<std::uint64_t>& numbers = numbers_[static_cast<std::size_t>(rank)];
    if (answers.energy.size() != numbers.size())
      throw LostError("there are answers of " + std::to_string(answers.energy.size()) + " cells, not " +
                          std::to_string(numbers.size()),
                      "rank " + std::to_string(rank), "report this");
    std::vector<char> fails(numbers.size(), 0);
    for (const Reason& reason : answers.reasons) {
      request.reason[numbers.at(reason.place)] = reason.text;
      fails[reason.place] = 1;
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const std::size_t p = numbers[k];
      seconds_[p] = answers.seconds[k];
      stepSeconds_[p] += answers.seconds[k];
      report_.busy[static_cast<std::size_t>(rank)] += answers.seconds[k];
      if (fails[k] != 0) continue;
      if (isNew(request)) {
        std::copy_n(&answers.P[9 * k], 9, &request.P[9 * p]);
        request.dissipated[p] = answers.dissipated[k];
      }
      if (request.withEnergy) request.energy[p] = answers.energy[k];
      if (!request.tangent.empty()) std::copy_n(&answers.tangent[81 * k], 81, &request.tangent[81 * p]);
    }
    threads_[static_cast<std::size_t>(rank)] = answers.threads;
  }

  void moveWhereItPays() { move(worthwhileMoves({owner_, stepSeconds_, threads_}, priceOfMove(bytesOfState_))); }
  void moveAtRandom() {
    std::vector<FarmMove> moves;
    for (std::size_t p = 0; p < owner_.size(); ++p)
      moves.push_back({p, static_cast<int>(random_() % static_cast<unsigned>(mail_.ranks()))});
    move(moves);
  }
  void move(const std::vector<FarmMove>& moves) {
    std::vector<int> to = owner_;
    for (const FarmMove& each : moves) to[each.point] = each.to;
    std::vector<std::uint64_t> moving;
    for (std::size_t p = 0; p < owner_.size(); ++p)
      if (to[p] != owner_[p]) moving.push_back(p);
    for (std::size_t first = 0; first < moving.size(); first += block) {
      const std::vector<std::uint64_t> some(
          moving.begin() + static_cast<std::ptrdiff_t>(first),
          moving.begin() + static_cast<std::ptrdiff_t>(std::min(first + block, moving.size())));
      std::vector<std::vector<char>> states = statesOf(some, Verb::give);
      std::vector<std::vector<Parcel>> parcels(numbers_.size());
      for (std::size_t k = 0; k < some.size(); ++k) {
        const auto from = static_cast<std::size_t>(owner_[some[k]]);
        if (from == 0) own_.drop(some[k]);
        std::erase(numbers_[from], some[k]);
        --report_.points[from];
        parcels[static_cast<std::size_t>(to[some[k]])].push_back({some[k], sample_[some[k]], std::move(states[k])});
      }
      for (std::size_t rank = 0; rank < parcels.size(); ++rank) deliver(static_cast<int>(rank), parcels[rank]);
      mail_.settle();
    }
    report_.moves += static_cast<std::int64_t>(moving.size());
  }

  CellRecipe recipe_;
  std::string name_;
  double density_;
  Deal deal_;
  Mail& mail_;
  FarmMoving moving_;
  FarmShare own_;
  std::uint64_t field_;
  std::vector<std::uint64_t> sample_;
  std::vector<int> owner_;                           ///< of each point
  std::vector<std::vector<std::uint64_t>> numbers_;  ///< of the points of each rank, in the order that it has
  std::vector<double> seconds_;                      ///< that each point took the last time
  std::vector<double> stepSeconds_;                  ///< and since the last commit
  std::vector<int> threads_;                         ///< of each rank
  std::mt19937_64 random_;
  FarmReport report_;
  mutable std::vector<std::unique_ptr<fem::FieldPoint>> seen_;  ///< a block of points of others, to look at
  mutable std::size_t firstSeen_ = 0;
  mutable std::vector<int> copies_;             ///< of all cells, once somebody has asked
  mutable std::size_t bytesOfState_ = 100'000;  ///< of a cell, once one was seen
  bool answered_ = false;                       ///< whether all points answer for F that was asked last
};

}  // namespace

bool mayTravel(const std::vector<rve::Rve>& samples) {
  try {
    ByteWriter bytes;
    rve::writeCells(samples, bytes, "cells of a farm");
    ByteReader back(bytes.take());
    rve::readCells(back, "cells of a farm");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::shared_ptr<fem::PointField> farmedField(const CellRecipe& recipe, Deal deal, Mail& mail, FarmMoving moving) {
  return std::make_shared<FarmedField>(recipe, std::move(deal), mail, moving);
}

int ranksOfFarm() {
  const Mail* const mail = mailOfFarm();
  return mail ? mail->ranks() : 1;
}

std::optional<int> copiesInFarm(const fem::PointField& field, std::size_t point) {
  const auto* const farmed = dynamic_cast<const FarmedField*>(&field);
  return farmed ? std::optional(farmed->copies(point)) : std::nullopt;
}

const FarmReport* farmReport(const fem::PointField& field) {
  const auto* const farmed = dynamic_cast<const FarmedField*>(&field);
  return farmed ? &farmed->report() : nullptr;
}

}  // namespace dovetail::hierarchical
