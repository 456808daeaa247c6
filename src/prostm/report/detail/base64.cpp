#include "prostm/report/detail/base64.hpp"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

namespace prostm::report::detail {

std::string base64(std::string_view bytes) {
  namespace iterators = boost::archive::iterators;
  using Encoder = iterators::base64_from_binary<iterators::transform_width<const char*, 6, 8>>;
  // the iterators look at a whole group of three bytes
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  std::string whole(bytes);
  whole.append(padding, '\0');
  std::string out(Encoder(whole.data()), Encoder(whole.data() + whole.size()));
  for (std::size_t i = 0; i < padding; ++i) out[out.size() - 1 - i] = '=';
  return out;
}

}  // namespace prostm::report::detail
