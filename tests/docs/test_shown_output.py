import unittest

from shown_output import difference

PRINTED = """listening on 127.0.0.1:40001
modes: 4314 unknowns; about 7 s on this machine
  mass       0.1126 kg
  mass       0.2 kg
force 0 N (peak 0.32 N)
"""


class TestShownOutput(unittest.TestCase):
    def check(self, shown, wrong, numbers=True):
        found = difference(shown, PRINTED, numbers)
        self.assertIn(wrong, found)
        self.assertTrue(wrong or not found, found)

    def test_lines_may_lack_between_those_that_are_shown(self):
        self.check(["listening on 127.0.0.1:40001", "force 0 N (peak 0.32 N)"], "")

    def test_ports_and_times_of_a_machine_are_any(self):
        self.check(["listening on 127.0.0.1:1", "modes: 4314 unknowns; about 31 s on this machine"], "")

    def test_numbers_are_near(self):
        self.check(["  mass 0.1127 kg"], "")
        self.check(["  mass 0.116 kg"], "'mass       0.1126 kg' was printed")
        self.check(["  mass 0.116 kg"], "", numbers=False)
        self.check(["force 0.001 N (peak 0.32 N)"], "was printed")

    def test_a_later_line_with_the_same_words_counts(self):
        self.check(["  mass 0.2 kg"], "")

    def test_words_are_the_same(self):
        self.check(["  weight 0.1126 kg"], "the page shows 'weight 0.1126 kg', nothing like it was printed")
        self.check(["force 0 N (peak 0.32 mN)"], "nothing like it was printed")

    def test_the_order_is_the_same(self):
        self.check(["force 0 N (peak 0.32 N)", "listening on 127.0.0.1:40001"], "nothing like it was printed")
        self.check(["  mass 0.2 kg", "  mass 0.1126 kg"], "nothing like it was printed")


if __name__ == "__main__":
    unittest.main()
