// SPDX-License-Identifier: Apache-2.0
// A base class for test catalogues that replace single functions of another catalogue.
#pragma once

#include "server/catalogue/catalogue.h"
#include "support/product_names.h"

namespace vitrine::test {

// A catalogue that forwards all calls to another catalogue. Tests derive from this class to replace
// single functions.
class CatalogueBefore : public Catalogue {
 public:
  explicit CatalogueBefore(Catalogue& before) : before_(before) {}

  Expected<void> add(const ModelRecord& model, std::span<const ChunkPlace> chunks,
                     const std::optional<JobClaim>& by) override {
    return before_.add(model, chunks, by);
  }
  Expected<void> set_state(const ModelId& id, ModelState state) override {
    return before_.set_state(id, state);
  }
  Expected<void> update(const ModelRecord& model, std::optional<std::span<const ChunkPlace>> chunks,
                        const std::optional<JobClaim>& by) override {
    return before_.update(model, chunks, by);
  }
  Expected<void> remove(const ModelId& id, std::optional<std::uint64_t> version) override {
    return before_.remove(id, version);
  }
  Expected<std::vector<NamedFile>> files() override { return before_.files(); }
  Expected<std::vector<TokenRecord>> tokens() override { return before_.tokens(); }
  Expected<std::optional<server::ModelRecord>> find(const ModelId& id) override {
    return before_.find(id);
  }
  Expected<std::optional<ModelRecord>> find_same(const ModelRecord& model) override {
    return before_.find_same(model);
  }
  Expected<ModelPage> search(const ModelQuery& query) override { return before_.search(query); }
  Expected<std::vector<ModelId>> page_cursors(std::uint32_t size) override {
    return before_.page_cursors(size);
  }
  Expected<server::Facets> facets(const ModelQuery& query) override {
    return before_.facets(query);
  }
  Expected<server::Harvest> harvest(const server::HarvestQuery& query) override {
    return before_.harvest(query);
  }
  Expected<std::vector<std::string>> collections() override { return before_.collections(); }
  Expected<std::optional<ChunkLocation>> find_chunk_after(const Sha256& chunk,
                                                          const ModelId& after) override {
    return before_.find_chunk_after(chunk, after);
  }
  Expected<std::vector<Sha256>> public_chunks(const ModelId& id) override {
    return before_.public_chunks(id);
  }
  Expected<void> add_token(const server::TokenRecord& token) override {
    return before_.add_token(token);
  }
  Expected<std::vector<TokenRecord>> tokens_like(const Sha256& hash) override {
    return before_.tokens_like(hash);
  }
  Expected<void> revoke_token(const TokenId& id) override { return before_.revoke_token(id); }
  Expected<std::uint64_t> revision() override { return before_.revision(); }
  void when_hidden(ChunksHidden hidden) override { before_.when_hidden(std::move(hidden)); }

 protected:
  Catalogue& before_;
};

}  // namespace vitrine::test
