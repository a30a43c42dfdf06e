import js from '@eslint/js';
import globals from 'globals';

const given = { argsIgnorePattern: '^(_|values|hidden)$', varsIgnorePattern: '^_' };

export default [
  js.configs.recommended,
  {
    files: ['wmrbook/panel/**/*.js'],
    languageOptions: { globals: { ...globals.browser, wmrKit: 'readonly' } },
    rules: { 'no-unused-vars': ['error', given], 'no-var': 'error', 'prefer-const': 'error' },
  },
];
