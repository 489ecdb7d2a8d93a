"""The plainest implementation of each contract; registered exactly as third parties do."""
