#include <memory>
#include <utility>

#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/ranks/post.hpp"
#include "dovetail/ranks/session.hpp"
#include "mail.hpp"
#include "worker.hpp"

namespace dovetail::hierarchical {

namespace {

class RankMail final : public Mail {
public:
  ~RankMail() override {
    try {
      for (int rank = 1; rank < ranks(); ++rank) post_.send(rank, {});
      post_.settle();
    } catch (...) {  // the others are gone
    }
  }
  int ranks() const override { return ranks::count(); }
  void send(int to, std::vector<char> bytes) override { post_.send(to, std::move(bytes)); }
  void settle() override { post_.settle(); }
  Letter receive() override {
    ranks::Post::Arrived arrived = post_.receive();
    return {arrived.from, std::move(arrived.bytes)};
  }

private:
  ranks::Post post_;
};

std::unique_ptr<RankMail>& theMail() {
  static std::unique_ptr<RankMail> mail;  // made after the session, which thus ends later
  return mail;
}

void serve() {
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
