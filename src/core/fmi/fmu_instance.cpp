#include "fmi/fmu_instance.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

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

const FmuInstance::State& state_at(const void* state) {
  if (state == nullptr) throw std::invalid_argument("the state is NULL");
  return *static_cast<const FmuInstance::State*>(state);
}

}  // namespace

FmuInstance::FmuInstance(const std::string& resources, const std::string& token, Log log)
    : token_(digest_of(reinterpret_cast<const unsigned char*>(token.data()), token.size())),
      data_(data_in(resources, token)),
      model_(FmuModel::of(data_)),
      log_(std::move(log)) {}

FmuInstance* FmuInstance::make(const char* resources, const char* token, const char* objection, const Log& log) {
  try {
    if (objection != nullptr) throw std::invalid_argument(objection);
    if (token == nullptr || resources == nullptr) throw std::invalid_argument("token or place of resources is NULL");
    return new FmuInstance(resources, token, log);
  } catch (const std::exception& wrong) {
    if (log) log(FMU_ERROR, wrong.what());
    return nullptr;
  }
}

FmuStatus FmuInstance::refuse(const std::string& what) const {
  if (log_) log_(FMU_ERROR, what);
  return FMU_ERROR;
}

template <class Work>
FmuStatus FmuInstance::guarded(const Work& work) const noexcept {
  try {
    try {
      work();
      return FMU_OK;
    } catch (const std::exception& wrong) { return refuse(wrong.what()); }
  } catch (...) {  // no memory even for the words
    return FMU_FATAL;
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

FmuStatus FmuInstance::change(Stage from, Stage to, const char* what) {
  return guarded([&] { require(from, what), stage_ = to; });
}

FmuStatus FmuInstance::enter_initialization() {
  return change(Stage::INSTANTIATED, Stage::INITIALIZING, "initialization");
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

FmuStatus FmuInstance::terminate() { return change(Stage::STEPPING, Stage::TERMINATED, "the end"); }

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

void FmuInstance::replace(void** state, std::unique_ptr<State> by) {
  delete static_cast<State*>(*state);
  *state = by.release();
}

FmuStatus FmuInstance::keep(void** state) const {
  return guarded([&] { replace(state, std::make_unique<State>(State{model_->copy(), stage_, start_time_})); });
}

FmuStatus FmuInstance::free_state(void** state) {
  replace(state, nullptr);
  return FMU_OK;
}

FmuStatus FmuInstance::take(const void* state) {
  return guarded([&] {
    const State& kept = state_at(state);
    model_ = kept.model->copy();
    stage_ = kept.stage, start_time_ = kept.start_time;
  });
}

Bytes FmuInstance::bytes(const void* state) const {
  const State& kept = state_at(state);
  if (kept.stage == Stage::FAILED) throw std::logic_error("a state after a step that has failed has no form in bytes");
  ByteWriter out;
  out.put(token_), out.whole(std::int64_t(kept.stage)), out.number(kept.start_time);
  kept.model->write(out);
  return out.sealed(STATE);
}

FmuStatus FmuInstance::size(const void* state, std::size_t* size) const {
  return guarded([&] { *size = bytes(state).size(); });
}

FmuStatus FmuInstance::write(const void* state, void* to, std::size_t size) const {
  return guarded([&] {
    const Bytes from = bytes(state);
    if (to == nullptr || size < from.size())
      throw std::invalid_argument("the state takes " + std::to_string(from.size()) + " bytes; there is room for " +
                                  std::to_string(to == nullptr ? 0 : size));
    std::copy(from.begin(), from.end(), static_cast<unsigned char*>(to));
  });
}

FmuStatus FmuInstance::read(const void* bytes, std::size_t size, void** state) const {
  return guarded([&] {
    ByteReader in = ByteReader::opened(STATE, static_cast<const unsigned char*>(bytes), size);
    if (in.take() != token_) refuse_bytes("they are that of another model");
    const auto stage = Stage(in.whole(0, std::int64_t(Stage::TERMINATED)));
    auto read = std::make_unique<State>(State{FmuModel::of(data_), stage, in.number()});
    read->model->read(in);
    in.require_end();
    replace(state, std::move(read));
  });
}

}  // namespace skisnow
