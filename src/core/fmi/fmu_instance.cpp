#include "fmi/fmu_instance.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace skisnow {

namespace {

constexpr std::uint64_t STATE = 2;           // of an FMU, among what is kept as bytes
constexpr const char* DATA = "skisnow.txt";  // in the folder of the resources; its first word is the token

Fields data_in(const std::string& resources, const std::string& token) {
  const std::string path = resources + "/" + DATA;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path + " cannot be read");
  std::string own;
  in >> own;
  if (own != token) throw std::runtime_error(path + " belongs to another model: its token is " + own);
  std::ostringstream text;
  text << in.rdbuf();
  return Fields::read(text.str());
}

}  // namespace

FmuInstance::FmuInstance(const std::string& resources, const std::string& token, Log log)
    : token_(digest_of(reinterpret_cast<const unsigned char*>(token.data()), token.size())),
      data_(data_in(resources, token)),
      model_(FmuModel::of(data_)),
      log_(std::move(log)) {}

FmuStatus FmuInstance::refuse(const std::string& what) const {
  if (log_) log_(FmuStatus::ERROR, what);
  return FmuStatus::ERROR;
}

template <class Work>
FmuStatus FmuInstance::guarded(const Work& work) const noexcept {
  try {
    try {
      work();
      return FmuStatus::OK;
    } catch (const std::exception& wrong) { return refuse(wrong.what()); }
  } catch (...) {  // no memory even for the words
    return FmuStatus::FATAL;
  }
}

void FmuInstance::require(Stage stage, const char* what) const {
  if (stage_ != stage) throw std::logic_error(std::string(what) + " is not allowed now");
}

FmuStatus FmuInstance::set_up(double start_time) {
  return guarded([&] {
    if (stage_ != Stage::INSTANTIATED) throw std::logic_error("the start time can no longer be set");
    if (!std::isfinite(start_time)) throw std::invalid_argument("the start time is no finite number");
    start_time_ = model_->values[0] = start_time;
  });
}

FmuStatus FmuInstance::enter_initialization() {
  return guarded([&] {
    require(Stage::INSTANTIATED, "initialization");
    stage_ = Stage::INITIALIZING;
  });
}

FmuStatus FmuInstance::exit_initialization() {
  return guarded([&] {
    require(Stage::INITIALIZING, "the end of the initialization");
    stage_ = Stage::FAILED;
    model_->begin(start_time_);
    stage_ = Stage::STEPPING;
  });
}

FmuStatus FmuInstance::step(double from, double length) {
  return guarded([&] {
    require(Stage::STEPPING, "a step");
    if (!(std::isfinite(from) && std::isfinite(length) && length > 0.0))
      throw std::invalid_argument("a step must have a finite time and a length above 0");
    stage_ = Stage::FAILED;
    model_->step(from, from + length);
    stage_ = Stage::STEPPING;
  });
}

FmuStatus FmuInstance::terminate() {
  return guarded([&] {
    require(Stage::STEPPING, "the end");
    stage_ = Stage::TERMINATED;
  });
}

FmuStatus FmuInstance::reset() {
  return guarded([&] {
    model_ = FmuModel::of(data_);
    stage_ = Stage::INSTANTIATED, start_time_ = 0.0;
  });
}

FmuStatus FmuInstance::get(const unsigned* reference, std::size_t count, double* value) const {
  return guarded([&] {
    for (std::size_t i = 0; i < count; i++) {
      if (reference[i] >= model_->values.size())
        throw std::invalid_argument("there is no variable " + std::to_string(reference[i]));
      value[i] = model_->values[reference[i]];
    }
  });
}

FmuStatus FmuInstance::set(const unsigned* reference, std::size_t count, const double* value) {
  return guarded([&] {
    const bool begun = stage_ != Stage::INSTANTIATED && stage_ != Stage::INITIALIZING;
    for (std::size_t i = 0; i < count; i++) {
      const std::string name = "variable " + std::to_string(reference[i]);
      if (!model_->is_input(reference[i]) && !(model_->is_parameter(reference[i]) && !begun))
        throw std::invalid_argument(name + " cannot be set now");
      if (!std::isfinite(value[i])) throw std::invalid_argument(name + " is given a number that is not finite");
    }
    for (std::size_t i = 0; i < count; i++) model_->values[reference[i]] = value[i];
  });
}

FmuStatus FmuInstance::keep(State** state) const {
  return guarded([&] {
    auto kept = std::make_unique<State>(State{model_->copy(), stage_, start_time_});
    delete *state;
    *state = kept.release();
  });
}

FmuStatus FmuInstance::take(const State* state) {
  return guarded([&] {
    if (state == nullptr) throw std::invalid_argument("the state is NULL");
    model_ = state->model->copy();
    stage_ = state->stage, start_time_ = state->start_time;
  });
}

Bytes FmuInstance::bytes(const State* state) const {
  if (state == nullptr) throw std::invalid_argument("the state is NULL");
  if (state->stage == Stage::FAILED)
    throw std::logic_error("a state after a step that has failed has no form in bytes");
  ByteWriter out;
  out.put(token_), out.whole(std::int64_t(state->stage)), out.number(state->start_time);
  state->model->write(out);
  return out.sealed(STATE);
}

FmuStatus FmuInstance::size(const State* state, std::size_t* size) const {
  return guarded([&] { *size = bytes(state).size(); });
}

FmuStatus FmuInstance::write(const State* state, unsigned char* to, std::size_t size) const {
  return guarded([&] {
    const Bytes from = bytes(state);
    if (to == nullptr || size < from.size())
      throw std::invalid_argument("the state takes " + std::to_string(from.size()) + " bytes; there is room for " +
                                  std::to_string(to == nullptr ? 0 : size));
    std::copy(from.begin(), from.end(), to);
  });
}

FmuStatus FmuInstance::read(const unsigned char* bytes, std::size_t size, State** state) const {
  return guarded([&] {
    ByteReader in = ByteReader::opened(STATE, bytes, size);
    if (in.take() != token_) refuse_bytes("they are that of another model");
    const auto stage = Stage(in.whole(0, std::int64_t(Stage::TERMINATED)));
    auto read = std::make_unique<State>(State{FmuModel::of(data_), stage, in.number()});
    read->model->read(in);
    in.require_end();
    delete *state;
    *state = read.release();
  });
}

}  // namespace skisnow
