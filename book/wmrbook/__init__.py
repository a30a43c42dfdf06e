"""The book's own package: the figures of its chapters, the audit of the paper, the checks of the course, and the challenge."""
