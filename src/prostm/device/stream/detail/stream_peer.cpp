#include "prostm/device/stream/detail/stream_peer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace prostm::stream {

Peer::Peer() : out_(2 * kWaitingMost + kLongestMessage) {}

void Peer::open_tcp(Descriptor&& connection, Clock::time_point now) {
  close();
  connection_ = std::move(connection);
  state_ = State::Greeting;
  heard_ = sent_ = now;
}

void Peer::open_udp(const Descriptor& socket, const Address& address, Clock::time_point now) {
  close();
  udp_ = &socket;
  address_ = address;
  state_ = State::Greeting;
  heard_ = sent_ = now;
}

void Peer::subscribe(const Wishes& wishes, Clock::time_point now) {
  if (wishes != wishes_) {
    started_loop = loop_id_ = 0;
    loop_sent_ = 0;
  }
  wishes_ = wishes;
  heard_ = now;
  state_ = State::Subscribed;
}

void Peer::end(std::uint32_t session, Kind kind, Reason reason, Clock::time_point now) {
  send(session, now, [&](auto out, const Envelope& e) { return put_end(out, e, kind, reason); });
  if (!is_tcp()) return close();
  state_ = State::Closing;
  heard_ = now;
}

void Peer::close() {
  connection_.close();
  udp_ = nullptr;
  state_ = State::Free;
  wishes_ = {};
  sequence_ = 0;
  unread_ = head_ = tail_ = 0;
  skipped_ = 0;
  gap_ = false;
  started_loop = loop_id_ = 0;
  loop_sent_ = 0;
}

bool Peer::read() {
  if (unread_ == in_.size()) return true;  // process the buffered bytes first
  const auto got =
      recv(connection_.get(), in_.data() + unread_, in_.size() - unread_, MSG_DONTWAIT);
  if (got > 0) unread_ += static_cast<std::size_t>(got);
  return got > 0 || (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
}

void Peer::drop_read(std::size_t bytes) {
  std::copy(in_.begin() + static_cast<std::ptrdiff_t>(bytes),
            in_.begin() + static_cast<std::ptrdiff_t>(unread_), in_.begin());
  unread_ -= bytes;
}

bool Peer::flush() {
  while (has_waiting()) {
    const auto sent =
        ::send(connection_.get(), out_.data() + head_, tail_ - head_, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    head_ += static_cast<std::size_t>(sent);
  }
  head_ = tail_ = 0;
  // after its last message the receiver reads the end of the connection
  if (state_ == State::Closing) shutdown(connection_.get(), SHUT_WR);
  return true;
}

/// Returns room for a message; empty if the queue, unless it is empty, would exceed `most` bytes.
std::span<std::uint8_t> Peer::room(std::size_t bytes, std::size_t most) {
  if (has_waiting() && tail_ - head_ + bytes > most) return {};
  if (tail_ + bytes > out_.size()) {
    std::memmove(out_.data(), out_.data() + head_, tail_ - head_);
    tail_ -= head_;
    head_ = 0;
  }
  return std::span(out_).subspan(tail_, bytes);
}

/// Sends the message written into room(): UDP at once, TCP after the queued messages.
bool Peer::commit(std::size_t bytes, Clock::time_point now) {
  if (!is_tcp()) {
    if (!send_to(*udp_, std::span(out_).subspan(tail_, bytes), address_)) return false;
  } else {
    tail_ += bytes;
    flush();
  }
  ++sequence_;
  sent_ = now;
  return true;
}

bool Peer::send_block(std::uint32_t session, const BlockView& block, Clock::time_point now) {
  const std::size_t foci = wishes_.foci_of(block.foci), all = wished_samples(block, wishes_);
  const std::size_t at_once = is_tcp() ? all : samples_in(kDatagramBytes, foci);
  const auto samples = static_cast<std::int64_t>(block.count());
  std::size_t begin = 0;
  do {
    const std::size_t count = std::min(at_once, all - begin);
    const std::size_t bytes = kHeaderBytes + kBlockHeadBytes + count * foci * kFocusBytes;
    const auto out = room(bytes, kBlocksMost);
    if (out.empty() ||
        !commit(put_block(out, {session, sequence_}, block, wishes_, begin, count, skipped_, gap_),
                now)) {
      const auto left = static_cast<std::int64_t>((all - begin) * wishes_.stride);
      skipped_ += std::min(samples, left);
      gap_ = true;
      return false;
    }
    gap_ = false;
    begin += count;
  } while (begin < all);
  return true;
}

void Peer::send_loop(std::uint32_t session, const std::shared_ptr<const PlayedLoop>& loop,
                     Clock::time_point now) {
  if (loop_id_ != loop->id) {
    loop_id_ = loop->id;
    loop_sent_ = 0;
  }
  const BlockView view = loop->view();
  const std::size_t foci = wishes_.foci_of(view.foci);
  while (loop_sent_ < view.count()) {
    const std::size_t count = std::min(kLoopPart / foci, view.count() - loop_sent_);
    const auto out = room(kHeaderBytes + kLoopHeadBytes + count * foci * kFocusBytes, kBlocksMost);
    if (out.empty()) return;
    commit(put_loop(out, {session, sequence_}, loop->id, view, wishes_, loop_sent_, count), now);
    loop_sent_ += count;
  }
}

}  // namespace prostm::stream
