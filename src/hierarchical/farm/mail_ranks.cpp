#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/ranks/post.hpp"
#include "dovetail/ranks/session.hpp"
#include "mail.hpp"
#include "worker.hpp"

namespace dovetail::hierarchical {

namespace {

/// Once a rank is lost, nothing is sent any more, and the program ends without waiting for the others.
class RankMail final : public Mail {
public:
  ~RankMail() override {
    try {
      for (int rank = 1; rank < ranks(); ++rank) send(rank, {});
      settle();
    } catch (const std::exception&) {
      lost_ = true;
    }
    if (!lost_) return;
    std::cout.flush();
    std::_Exit(1);
  }
  int ranks() const override { return ranks::count(); }
  void send(int to, std::vector<char> bytes) override {
    if (!lost_) post_.send(to, std::move(bytes));
  }
  void settle() override {
    if (!lost_) noting([&] { post_.settle(); });
  }
  Letter receive() override {
    Letter letter{};
    noting([&] {
      ranks::Post::Arrived arrived = post_.receive();
      letter = {arrived.from, std::move(arrived.bytes)};
    });
    return letter;
  }

private:
  template <class Act>
  void noting(Act&& act) {
    try {
      act();
    } catch (const ranks::LostRank&) {
      lost_ = true;
      throw;
    }
  }

  ranks::Post post_;
  bool lost_ = false;
};

std::unique_ptr<RankMail>& theMail() {
  static std::unique_ptr<RankMail> mail;  // made after the session, which thus ends later
  return mail;
}

void answerLetters() {
  ranks::Post post;
  FarmWorker worker;
  for (;;) {
    ranks::Post::Arrived letter = post.receive();
    if (letter.bytes.empty()) return;
    if (std::optional<std::vector<char>> reply = worker.answer(std::move(letter.bytes))) {
      post.send(letter.from, std::move(*reply));
      post.settle();
    }
  }
}

/// When to end is rank 0's to decide: it may want a step to its end, and a checkpoint.
void serve() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  try {
    answerLetters();
  } catch (const ranks::LostRank&) {  // rank 0 tells
    std::_Exit(1);
  } catch (const std::exception& error) {
    std::cerr << "rank " << ranks::rank() << ": " << error.what() << std::endl;
    ranks::abortAll();
  }
}

}  // namespace

Mail* mailOfFarm() { return theMail().get(); }

bool serveFarm() {
  if (!ranks::launched()) return false;
  ranks::start();
  if (ranks::count() == 1) return false;
  if (ranks::rank() > 0) return serve(), true;
  theMail() = std::make_unique<RankMail>();
  return false;
}

}  // namespace dovetail::hierarchical
