"""What results say besides their numbers: a code, the numbers of the sentence, and the sentence."""
