#include "worker.hpp"

#include <new>
#include <utility>

#include "dovetail/core/error.hpp"

namespace dovetail::hierarchical {

namespace {

bool wantsReply(Verb verb) { return verb == Verb::give || verb == Verb::copy || verb == Verb::evaluate; }

}  // namespace

std::optional<std::vector<char>> FarmWorker::answer(std::vector<char> letter) {
  ByteReader reader(std::move(letter));
  Verb verb{};
  reader(verb);
  ByteWriter content;
  try {
    if (outcome_ == Outcome::done || verb == Verb::close) act(verb, reader, content);
  } catch (...) {
    noteFailure();
  }
  if (!wantsReply(verb)) return {};
  ByteWriter reply;
  const Outcome outcome = std::exchange(outcome_, Outcome::done);
  reply(outcome);
  if (outcome == Outcome::done)
    reply.append(content.bytes());
  else
    reply(std::exchange(failure_, {}));
  return reply.take();
}

void FarmWorker::act(Verb verb, ByteReader& letter, ByteWriter& reply) {
  std::uint64_t field = 0;
  letter(field);
  if (verb == Verb::open) {
    fields_.insert_or_assign(field, FarmShare(readRecipe(letter)));
    return;
  }
  if (verb == Verb::close) {
    fields_.erase(field);
    return;
  }
  FarmShare& share = fields_.at(field);
  if (verb == Verb::take) {
    std::vector<Parcel> parcels;
    letter(parcels);
    for (const Parcel& parcel : parcels) share.take(parcel);
  } else if (verb == Verb::give || verb == Verb::copy) {
    std::vector<std::uint64_t> numbers;
    letter(numbers);
    for (const std::uint64_t number : numbers) reply(share.stateOf(number));
    for (const std::uint64_t number : numbers)
      if (verb == Verb::give) share.drop(number);
  } else if (verb == Verb::evaluate) {
    Question question;
    letter(question);
    reply(share.evaluate(question));
  } else if (verb == Verb::clear) {
    share.clear();
  } else if (verb == Verb::commit) {
    share.commit();
  } else {
    share.revert();
  }
}

void FarmWorker::noteFailure() {
  try {
    throw;
  } catch (const InputError& error) {
    outcome_ = Outcome::inputError, failure_ = error.what();
  } catch (const NumericalError& error) {
    outcome_ = Outcome::numericalError, failure_ = error.what();
  } catch (const std::bad_alloc&) {
    outcome_ = Outcome::noMemory;
  } catch (const std::exception& error) {
    outcome_ = Outcome::otherError, failure_ = error.what();
  }
}

}  // namespace dovetail::hierarchical
