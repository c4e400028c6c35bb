"""The words of the column model: short, each with its sentence, and put together so that they are read again."""

from __future__ import annotations

from frictionlab.methods.words import AUTO, ModelWord, model_in_sentences, why_unique_in_words


def test_words_are_short_and_hold_no_mark_that_parts_them() -> None:
    assert max(map(len, ModelWord)) <= 24
    assert not any(mark in word for word in ModelWord for mark in ("; ", ", auto", AUTO))
    assert all(each.sentence for each in ModelWord)


def test_a_model_is_told_word_by_word() -> None:
    model = "20 harmonics by samples; unique: damped; a plugin's own (auto: fake, memory of friction)"

    assert model_in_sentences(model).split("; ") == [
        "20 harmonics of motion and of friction balanced on samples of a period, those beyond left out",
        ModelWord.DAMPED.sentence,
        "a plugin's own",
        "auto chose fake: exact needs friction without memory (Coulomb)",
    ]
    assert why_unique_in_words(model).startswith("dashpots damp")
    assert why_unique_in_words("by samples") == ""
