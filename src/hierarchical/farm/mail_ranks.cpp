#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <thread>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/ranks/post.hpp"
#include "dovetail/ranks/session.hpp"
#include "dovetail/ranks/team_of_ranks.hpp"
#include "launcher.hpp"
#include "letters.hpp"
#include "mail.hpp"
#include "worker.hpp"

namespace dovetail::hierarchical {

namespace {

constexpr const char* gone = "letters between ranks have come to an end";

/// Of rank 0, for one thread. Once a rank is lost or letters are out of step there are none any more.
class RankMail final : public Mail {
public:
  int ranks() const override { return ranks_; }
  void send(int to, std::vector<char> bytes) override {
    requireThread();
    if (!ended_) post_.send(to, std::move(bytes));
  }
  void settle() override {
    if (!ended_) noting([&] { post_.settle(); });
  }
  Letter receive() override {
    if (ended_) throw LostError(gone, "ranks", "start again");
    Letter letter{};
    noting([&] {
      ranks::Post::Arrived arrived = post_.receive();
      letter = {arrived.from, std::move(arrived.bytes)};
    });
    return letter;
  }
  void giveUp() override { ended_ = true; }
  bool isOfThisThread() const { return std::this_thread::get_id() == thread_; }

  /// The others leave their letters for a team.
  void callTogether() {
    for (int rank = 1; rank < ranks(); ++rank) send(rank, {static_cast<char>(Verb::join)});
    settle();
    joined_ = ended_ = true;
  }
  bool joined() const { return joined_; }

  /// The others end too. Where that cannot be told to them, the program does not wait for them.
  void sayFarewell() {
    if (joined_) return;
    try {
      for (int rank = 1; rank < ranks(); ++rank) send(rank, {});
      settle();
    } catch (const std::exception&) {
      ended_ = true;
    }
    if (ended_) {
      std::cout.flush();
      std::_Exit(1);
    }
    ended_ = true;
  }

private:
  void requireThread() const {
    if (!isOfThisThread())
      throw Error("cells on ranks are asked by another thread", "farm of cells", "ask from the thread of serveFarm()");
  }
  template <class Act>
  void noting(Act&& act) {
    try {
      act();
    } catch (const LostError&) {
      ended_ = true;
      throw;
    }
  }

  ranks::Post post_;
  int ranks_ = ranks::count();
  std::thread::id thread_ = std::this_thread::get_id();
  bool ended_ = false, joined_ = false;
};

/// Lives as long as the program: fields may outlive what ends the letters.
RankMail* theMail = nullptr;

struct Farewell {
  ~Farewell() { theMail->sayFarewell(); }
};

enum class After { end, team };

After answerLetters() {
  ranks::Post post;
  FarmWorker worker;
  for (;;) {
    ranks::Post::Arrived letter = post.receive();
    if (letter.bytes.empty()) return After::end;
    if (static_cast<Verb>(letter.bytes.front()) == Verb::join) return After::team;
    if (std::optional<std::vector<char>> reply = worker.answer(std::move(letter.bytes))) {
      post.send(letter.from, std::move(*reply));
      post.settle();
    }
  }
}

/// When to end is rank 0's to decide: it may want a step to its end, and a checkpoint.
After serve() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  try {
    return answerLetters();
  } catch (const LostError&) {  // rank 0 tells
    std::_Exit(1);
  } catch (const std::exception& error) {
    std::cerr << "rank " << ranks::rank() << ": " << error.what() << std::endl;
    ranks::abortAll();
  }
}

/// What all ranks have to say, the first one says.
void fallSilent() {
  std::cout.setstate(std::ios::badbit);
  std::cerr.setstate(std::ios::badbit);
  std::clog.setstate(std::ios::badbit);
  if (std::freopen("/dev/null", "w", stdout) == nullptr) std::fclose(stdout);
}

}  // namespace

Mail* mailOfFarm() { return theMail != nullptr && theMail->isOfThisThread() && !theMail->joined() ? theMail : nullptr; }

void formTeam() {
  if (mailOfFarm() == nullptr) return;
  theMail->callTogether();
  ranks::formTeam();
}

bool serveFarm() {
  if (theMail != nullptr || ranksLaunched() == 1) return false;
  ranks::start();
  if (ranks::count() == 1) return false;
  if (ranks::rank() > 0) {
    if (serve() == After::end) return true;
    ranks::formTeam();
    fallSilent();
    return false;
  }
  theMail = new RankMail;
  static const Farewell farewell;  // made after the session, which thus ends later
  return false;
}

}  // namespace dovetail::hierarchical
