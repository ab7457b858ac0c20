#include "worker.hpp"

#include <new>
#include <tuple>
#include <utility>

#include "dovetail/core/error.hpp"

namespace dovetail::hierarchical {

namespace {

bool wantsReply(Verb verb) {
  return verb == Verb::give || verb == Verb::copy || verb == Verb::count || verb == Verb::evaluate;
}

/// What is being thrown.
std::pair<Outcome, std::string> failureNow() {
  try {
    throw;
  } catch (const InputError& error) {
    return {Outcome::inputError, error.what()};
  } catch (const NumericalError& error) {
    return {Outcome::numericalError, error.what()};
  } catch (const std::bad_alloc&) {
    return {Outcome::lost, "there is not enough memory for the cells of this rank"};
  } catch (const std::exception& error) {
    return {Outcome::otherError, error.what()};
  }
}

std::vector<char> replyOf(Outcome outcome, const std::string& failure) {
  ByteWriter reply;
  reply(outcome, failure);
  return reply.take();
}

/// What letters say that want a reply.
void ask(FarmShare& share, Verb verb, ByteReader& letter, ByteWriter& reply) {
  reply(Outcome::done);
  if (verb == Verb::evaluate) {
    Question question;
    letter(question);
    reply(share.evaluate(question));
  } else if (verb == Verb::count) {
    reply(share.copies());
  } else {
    std::vector<std::uint64_t> numbers;
    letter(numbers);
    for (const std::uint64_t number : numbers) reply(share.stateOf(number));
    for (const std::uint64_t number : numbers)
      if (verb == Verb::give) share.drop(number);
  }
}

void tell(FarmShare& share, Verb verb, ByteReader& letter) {
  if (verb == Verb::take) {
    std::vector<Parcel> parcels;
    letter(parcels);
    for (const Parcel& parcel : parcels) share.take(parcel);
  } else if (verb == Verb::commit) {
    share.commit();
  } else {
    share.revert();
  }
}

}  // namespace

std::optional<std::vector<char>> FarmWorker::answer(std::vector<char> letter) {
  ByteReader reader(std::move(letter));
  Verb verb{};
  std::uint64_t number = 0;
  reader(verb, number);
  if (verb == Verb::close) {
    fields_.erase(number);
    return {};
  }
  Field& field = fields_[number];
  if (wantsReply(verb)) {
    if (field.outcome != Outcome::done) return replyOf(Outcome::lost, field.failure);
    ByteWriter reply;
    try {
      ask(field.share.value(), verb, reader, reply);
    } catch (...) {
      const auto [outcome, failure] = failureNow();
      return replyOf(outcome, failure);
    }
    return reply.take();
  }
  if (verb == Verb::clear && field.share) {
    field.share->clear();
    field.outcome = Outcome::done;
    return {};
  }
  try {
    if (verb == Verb::open) {
      field = {};
      field.share.emplace(readRecipe(reader));
    } else if (field.outcome == Outcome::done) {
      tell(field.share.value(), verb, reader);
    }
  } catch (...) {
    std::tie(field.outcome, field.failure) = failureNow();
  }
  return {};
}

}  // namespace dovetail::hierarchical
