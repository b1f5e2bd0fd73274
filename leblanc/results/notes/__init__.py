"""Notes: what a result says besides its numbers, as a code, the numbers of the sentence, and the sentence.

One function a sentence: limits of validity and findings.
"""
