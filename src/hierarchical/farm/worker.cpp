#include "worker.hpp"

#include <tuple>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/failure.hpp"

namespace dovetail::hierarchical {

namespace {

bool wantsReply(Verb verb) {
  return verb == Verb::give || verb == Verb::copy || verb == Verb::count || verb == Verb::evaluate;
}

std::vector<char> replyOf(Failure failure, const std::string& text) {
  ByteWriter reply;
  reply(failure, text);
  return reply.take();
}

/// What letters say that want a reply.
void ask(FarmShare& share, Verb verb, ByteReader& letter, ByteWriter& reply) {
  reply(Failure::none);
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
    if (field.failure != Failure::none) return replyOf(Failure::lost, field.text);
    ByteWriter reply;
    try {
      ask(field.share.value(), verb, reader, reply);
    } catch (...) {
      const auto [failure, text] = failureNow();
      return replyOf(failure, text);
    }
    return reply.take();
  }
  if (verb == Verb::clear && field.share) {
    field.share->clear();
    field.failure = Failure::none;
    return {};
  }
  try {
    if (verb == Verb::open) {
      field = {};
      field.share.emplace(readRecipe(reader));
    } else if (field.failure == Failure::none) {
      tell(field.share.value(), verb, reader);
    }
  } catch (...) {
    std::tie(field.failure, field.text) = failureNow();
  }
  return {};
}

}  // namespace dovetail::hierarchical
